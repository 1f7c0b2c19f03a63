// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "resect/body.hpp"

namespace bench {

/// A cube of 0.1 m without a regular edge: nodes jittered, random pairs of neighbours made three tets around
/// a new edge, nodes and tets in random order.
resect::Body make_unstructured_cube(resect::Index cells, std::uint64_t seed);

} // namespace bench
