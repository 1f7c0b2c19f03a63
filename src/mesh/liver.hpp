// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "resect/body.hpp"

namespace resect {

/// The liver of make_liver: negative inside, about a distance in metres; x to the patient's left, y
/// posterior, z cranial.
double liver_shape(const Vec3& p);

/// Where the liver lies, with room to spare.
inline constexpr Box liver_bounds = {{-0.126, -0.07, -0.085}, {0.126, 0.07, 0.09}};

} // namespace resect
