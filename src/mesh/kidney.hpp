// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "resect/body.hpp"

namespace resect {

/// The kidney of make_kidney: negative inside, about a distance in metres; z along its length, the hilum
/// towards +x, y through its thickness.
double kidney_shape(const Vec3& p);

/// Where the kidney lies, with room to spare.
inline constexpr Box kidney_bounds = {{-0.045, -0.032, -0.07}, {0.045, 0.032, 0.07}};

} // namespace resect
