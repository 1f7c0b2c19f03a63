// SPDX-License-Identifier: Apache-2.0
#include "mesh/implicit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vec.hpp"

namespace resect {

double smooth_min(double a, double b, double width) {
    const double overlap = std::max(width - std::abs(a - b), 0.0) / width;
    return std::min(a, b) - overlap * overlap * width / 4;
}

double smooth_max(double a, double b, double width) { return -smooth_min(-a, -b, width); }

Vec3 rotate_y(const Vec3& p, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]};
}

Vec3 rotate_z(const Vec3& p, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
}

/// With g(p) = |p / radii|, the surface is g = 1 and (g - 1) / |grad g| is the distance to first order. g
/// over its gradient's length goes to the least radius at the centre, where neither is defined.
double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radii) {
    const Vec3 q = p - centre;
    const Vec3 scaled = {q[0] / radii[0], q[1] / radii[1], q[2] / radii[2]};
    const double g = length(scaled);
    const double slope = length(Vec3{scaled[0] / radii[0], scaled[1] / radii[1], scaled[2] / radii[2]});
    if (slope == 0) { return -*std::min_element(radii.begin(), radii.end()); }
    return g * (g - 1) / slope;
}

double capsule(const Vec3& p, const Vec3& a, const Vec3& b, double radius) {
    const Vec3 axis = b - a;
    const double along = std::clamp(dot(p - a, axis) / dot(axis, axis), 0.0, 1.0);
    return length(p - a - along * axis) - radius;
}

} // namespace resect
