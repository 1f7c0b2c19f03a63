// SPDX-License-Identifier: Apache-2.0
#include "arrangement.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/index.hpp"

namespace resect::fuzz {
namespace {

using Polygon = std::vector<Vec3>;       // corners in turn
using Polyhedron = std::vector<Polygon>; // the faces of a convex body

constexpr double nothing = 1e-12; // share of the box below which a cell is rounding

Polyhedron make_box(const Box& box) {
    const auto corner = [&](unsigned bits) {
        return Vec3{(bits & 1U) != 0 ? box.hi[0] : box.lo[0], (bits & 2U) != 0 ? box.hi[1] : box.lo[1],
                    (bits & 4U) != 0 ? box.hi[2] : box.lo[2]};
    };
    constexpr unsigned faces[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1},
                                      {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
    Polyhedron made;
    for (const auto& face : faces) {
        made.push_back({corner(face[0]), corner(face[1]), corner(face[2]), corner(face[3])});
    }
    return made;
}

/// The part of a convex polygon where dot(plane) <= 0; points on the plane go to `rim`.
Polygon clip(const Polygon& polygon, const Plane& plane, Polygon& rim) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3& a = polygon[i];
        const Vec3& b = polygon[(i + 1) % polygon.size()];
        const double at_a = dot(plane.normal, a - plane.point);
        const double at_b = dot(plane.normal, b - plane.point);
        if (at_a <= 0) { kept.push_back(a); }
        if ((at_a <= 0) == (at_b <= 0)) { continue; }
        const Vec3 crossing = a + (at_a / (at_a - at_b)) * (b - a);
        kept.push_back(crossing);
        rim.push_back(crossing);
    }
    return kept;
}

Vec3 middle_of(const Polygon& points) {
    Vec3 sum = {};
    for (const Vec3& p : points) {
        sum += p;
    }
    return (1 / static_cast<double>(points.size())) * sum;
}

/// Points of a convex polygon across `normal`, in turn.
void sort_around(Polygon& points, const Vec3& normal) {
    const Vec3 middle = middle_of(points);
    const Vec3 first = direction(points.front() - middle);
    const Vec3 second = cross(direction(normal), first);
    std::sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
        const auto angle = [&](const Vec3& p) {
            return std::atan2(dot(second, p - middle), dot(first, p - middle));
        };
        return angle(a) < angle(b);
    });
}

Polyhedron clip(const Polyhedron& whole, const Plane& plane) {
    Polyhedron kept;
    Polygon rim;
    for (const Polygon& face : whole) {
        Polygon part = clip(face, plane, rim);
        if (part.size() >= 3) { kept.push_back(std::move(part)); }
    }
    if (rim.size() >= 3) {
        sort_around(rim, plane.normal);
        kept.push_back(std::move(rim));
    }
    return kept;
}

/// Of a convex body: cones from a point inside over its faces.
double volume_of(const Polyhedron& body) {
    if (body.size() < 4) { return 0; }
    Polygon corners;
    for (const Polygon& face : body) {
        corners.insert(corners.end(), face.begin(), face.end());
    }
    const Vec3 apex = middle_of(corners);
    double volume = 0;
    for (const Polygon& face : body) {
        Vec3 twice_area = {};
        for (std::size_t i = 1; i + 1 < face.size(); ++i) {
            twice_area += cross(face[i] - face[0], face[i + 1] - face[0]);
        }
        volume += std::abs(dot(twice_area, face[0] - apex)) / 6;
    }
    return volume;
}

} // namespace

std::vector<double> compute_cells(const Box& box, std::span<const Plane> planes) {
    std::vector<Polyhedron> cells = {make_box(box)};
    const double least = nothing * volume_of(cells.front());
    for (const Plane& plane : planes) {
        const Plane turned = {-1.0 * plane.normal, plane.point};
        std::vector<Polyhedron> parts;
        for (const Polyhedron& cell : cells) {
            for (const Plane& side : {plane, turned}) {
                Polyhedron part = clip(cell, side);
                if (volume_of(part) > least) { parts.push_back(std::move(part)); }
            }
        }
        cells = std::move(parts);
    }
    std::vector<double> volumes;
    volumes.reserve(cells.size());
    for (const Polyhedron& cell : cells) {
        volumes.push_back(volume_of(cell));
    }
    std::sort(volumes.begin(), volumes.end());
    return volumes;
}

} // namespace resect::fuzz
