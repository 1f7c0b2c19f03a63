// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "resect/setup.hpp"

namespace resect {

/// The first thing in a setup that could not be simulated, in one line; the mesh itself is checked by
/// mend_and_validate and make_cutter.
Result<void> check_setup(const Setup& setup);
/// `at`: row of Setup::materials.
Result<void> check_material(const Material& material, std::size_t at);
Result<void> check_gravity(const Vec3& gravity);

} // namespace resect
