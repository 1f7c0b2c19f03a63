// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "resect/body.hpp"

// Implicit shapes: negative inside, about the distance in metres near their surface.
namespace resect {

/// The least of two values, rounded where they differ by less than `width`.
double smooth_min(double a, double b, double width);

/// The greatest of two values, rounded where they differ by less than `width`.
double smooth_max(double a, double b, double width);

/// Turned about the y axis, or the z axis, right-handed.
Vec3 rotate_y(const Vec3& p, double degrees);
Vec3 rotate_z(const Vec3& p, double degrees);

double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radii);

/// All points nearer than `radius` to the segment from a to b.
double capsule(const Vec3& p, const Vec3& a, const Vec3& b, double radius);

} // namespace resect
