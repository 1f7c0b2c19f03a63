// SPDX-License-Identifier: Apache-2.0
#include "lab/sheet.hpp"

#include <algorithm>
#include <limits>

#include "base/vec.hpp"
#include "mesh/tet.hpp"

namespace lab {

using namespace resect;

namespace {

/// Nearest to p on the triangle: on its plane, or on the nearest of its sides.
Vec3 nearest_on(const std::array<Vec3, 3>& t, const Vec3& p) {
    const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
    const double area = dot(normal, normal);
    bool is_over = area > 0;
    Vec3 nearest = t[0];
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& a = t[k];
        const Vec3 side = t[(k + 1) % 3] - a;
        is_over = is_over && dot(cross(side, p - a), normal) >= 0;
        const double s = dot(side, side) > 0 ? std::clamp(dot(p - a, side) / dot(side, side), 0.0, 1.0) : 0;
        const Vec3 on_side = a + s * side;
        if (const double away = length(p - on_side); away < least) {
            least = away;
            nearest = on_side;
        }
    }
    return is_over ? p - (dot(p - t[0], normal) / area) * normal : nearest;
}

bool crosses_triangle(const std::array<Vec3, 3>& t, const Vec3& a, const Vec3& b) {
    const double side_a = signed_volume(t[0], t[1], t[2], a);
    const double side_b = signed_volume(t[0], t[1], t[2], b);
    if ((side_a < 0) == (side_b < 0)) { return false; }
    const bool first = signed_volume(a, b, t[0], t[1]) < 0;
    const bool second = signed_volume(a, b, t[1], t[2]) < 0;
    const bool third = signed_volume(a, b, t[2], t[0]) < 0;
    return first == second && second == third;
}

} // namespace

Sheet::Sheet(std::vector<Edge> poses) : poses_(std::move(poses)) {
    for (std::size_t i = 1; i < poses_.size(); ++i) {
        const Edge& from = poses_[i - 1];
        const Edge& to = poses_[i];
        triangles_.push_back({from.heel, from.tip, to.tip});
        triangles_.push_back({from.heel, to.tip, to.heel});
    }
}

bool Sheet::crosses(const Vec3& a, const Vec3& b) const {
    return std::any_of(triangles_.begin(), triangles_.end(),
                       [&](const auto& triangle) { return crosses_triangle(triangle, a, b); });
}

Vec3 Sheet::nearest(const Vec3& p) const {
    Vec3 nearest = {};
    double least = std::numeric_limits<double>::infinity();
    for (const auto& triangle : triangles_) {
        const Vec3 on_triangle = nearest_on(triangle, p);
        if (const double away = length(p - on_triangle); away < least) {
            least = away;
            nearest = on_triangle;
        }
    }
    return nearest;
}

double Sheet::distance(const Vec3& p) const { return length(p - nearest(p)); }

Sheet flat_notch(const Vec3& mouth, const Vec3& tip, double width) {
    const Vec3 heel = mouth + 0.5 * (mouth - tip);
    const auto at = [&](double y) { return Edge{{heel[0], y, heel[2]}, {tip[0], y, tip[2]}}; };
    return Sheet({at(-0.25 * width), at(1.25 * width)});
}

} // namespace lab
