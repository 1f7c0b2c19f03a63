// SPDX-License-Identifier: Apache-2.0
#include "mesh/kidney.hpp"

#include <algorithm>
#include <cmath>

#include "base/vec.hpp"
#include "mesh/implicit.hpp"

namespace resect {
namespace {

/// A tube around an arc of a circle: the bean. Its cross-section is wider than thick.
double bean(const Vec3& p) {
    constexpr double bend = 0.042, width = 0.026, thickness = 0.020, half_angle = 0.95;
    const Vec3 round = {p[0] - 0.034, p[1] * (width / thickness), p[2]};
    const double angle = std::clamp(std::atan2(round[2], -round[0]), -half_angle, half_angle);
    const Vec3 on_arc = {-bend * std::cos(angle), 0, bend * std::sin(angle)};
    return (length(round - on_arc) - width) * (thickness / width);
}

} // namespace

double kidney_shape(const Vec3& p) {
    const double middle = ellipsoid(p, {-0.006, 0, 0}, {0.027, 0.021, 0.040});
    const double hilum = ellipsoid(p, {0.034, 0, 0}, {0.022, 0.012, 0.017});
    return smooth_max(smooth_min(bean(p), middle, 0.010), -hilum, 0.008);
}

Result<Body> make_kidney(Lattice lattice) { return make_body(kidney_shape, kidney_bounds, lattice); }

} // namespace resect
