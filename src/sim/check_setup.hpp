// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "resect/setup.hpp"

namespace resect {

/// The first thing in a setup that could not be simulated, in one line; the mesh itself is checked by
/// mend_and_validate and make_cutter.
Result<void> check_setup(const Setup& setup);
Result<void> check_gravity(const Vec3& gravity);

} // namespace resect
