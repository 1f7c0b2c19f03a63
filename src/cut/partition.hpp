// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "cut/cutter_state.hpp"

namespace resect {

/// [4 * copy + corner] The lowest pair of its class: pairs with one reference node are joined where a linked
/// material face lies on an element face that holds the node. From scratch, over the whole mesh.
std::vector<Index> label_pairs(const Cutter& cutter);

} // namespace resect
