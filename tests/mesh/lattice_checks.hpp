// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "resect/body.hpp"

namespace resect {

/// What holds for every lattice body: congruent elements, material in its elements, faces that conform, a
/// closed boundary, no tiny tet, sums that agree.
void check_lattice_body(const Body& body);

} // namespace resect
