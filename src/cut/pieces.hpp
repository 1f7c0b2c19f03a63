// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cut/cutter_state.hpp"

namespace resect {

/// Brings ids and volumes up to date with the material's topology.
void relabel_pieces(Cutter& cutter);

} // namespace resect
