// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "resect/files.hpp"

namespace resect {

/// [element] The share of its volume that is material; all 1 where the material fills the elements.
std::vector<double> compute_fractions(const Body& body);

/// All of describe() but the time step. Components, boundary and volume are those of the material; the rest
/// is the elements'. A body without tets gives zeros.
MeshInfo measure_body(const Body& body);

} // namespace resect
