// SPDX-License-Identifier: Apache-2.0
#include "cut/blade.hpp"

#include <algorithm>
#include <cmath>

namespace resect {
namespace {

/// A unit vector across `along`, near `guess`.
Vec3 make_across(const Vec3& guess, const Vec3& along) {
    return direction(guess - dot(guess, along) * along);
}

BladeFrame place_frame(const Edge& pose, const Vec3& along, const Vec3& across) {
    return {pose.tip, across, cross(along, across), along, length(pose.heel - pose.tip)};
}

} // namespace

bool is_sound(const Edge& pose) {
    const double reach = length(pose.heel - pose.tip);
    return is_finite(pose.heel) && is_finite(pose.tip) && std::isfinite(reach) && reach > 0;
}

double distance_to(const Edge& pose, const Vec3& point) {
    const Vec3 along = pose.heel - pose.tip;
    const Vec3 away = point - pose.tip;
    const double t = std::clamp(dot(away, along) / dot(along, along), 0.0, 1.0);
    return length(away - t * along);
}

BladeFrame make_frame(const Edge& pose) {
    const Vec3 along = direction(pose.heel - pose.tip);
    const Vec3 guess = std::abs(along[0]) < 0.8 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return place_frame(pose, along, make_across(guess, along));
}

BladeFrame carry_frame(const BladeFrame& frame, const Edge& pose) {
    const Vec3 along = direction(pose.heel - pose.tip);
    const double nearness = 1 + dot(frame.along, along);
    if (nearness < 1e-9) {
        return place_frame(pose, along, make_across(frame.across1, along));
    } // turned about
    const Vec3 turned = frame.across1 - (dot(frame.across1, along) / nearness) * (frame.along + along);
    return place_frame(pose, along, make_across(turned, along));
}

} // namespace resect
