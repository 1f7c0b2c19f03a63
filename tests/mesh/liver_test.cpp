// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <set>

#include "mesh/adjacency.hpp"
#include "mesh/lattice_checks.hpp"
#include "mesh/liver.hpp"
#include "mesh/made.hpp"
#include "mesh/quality.hpp"

using namespace resect;

namespace {

std::vector<Triangle> surface_of(const Body& body) {
    return build_boundary(body.material, build_face_mates(body.material));
}

Vec3 slope_at(const Vec3& p) {
    constexpr double h = 1e-6;
    Vec3 slope = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3 ahead = p;
        Vec3 behind = p;
        ahead[axis] += h;
        behind[axis] -= h;
        slope[axis] = (liver_shape(ahead) - liver_shape(behind)) / (2 * h);
    }
    return slope;
}

/// Points that cover a triangle evenly: its corners, the middles of its sides and its centre.
std::vector<Vec3> samples_of(const TetMesh& mesh, const Triangle& triangle) {
    const Vec3& a = mesh.nodes[row(triangle[0])];
    const Vec3& b = mesh.nodes[row(triangle[1])];
    const Vec3& c = mesh.nodes[row(triangle[2])];
    return {a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), 1.0 / 3 * (a + b + c)};
}

/// Root mean square of the distance from the mesh's surface to the shape's, m.
double rms_to_shape(const Body& body) {
    double sum = 0;
    double area = 0;
    for (const Triangle& triangle : surface_of(body)) {
        const auto points = samples_of(body.material, triangle);
        const double weight = length(cross(points[1] - points[0], points[2] - points[0]));
        for (const Vec3& p : points) {
            const double distance = liver_shape(p) / length(slope_at(p));
            sum += weight * distance * distance;
            area += weight;
        }
    }
    return std::sqrt(sum / area);
}

/// Squared distance from a point to a triangle: the least over its plane's foot, if that lies inside, and
/// sides.
double squared_distance(const Vec3& p, const std::array<Vec3, 3>& corners) {
    const Vec3 normal = direction(cross(corners[1] - corners[0], corners[2] - corners[0]));
    const double height = dot(p - corners[0], normal);
    bool inside = true;
    double least = dot(p - corners[0], p - corners[0]);
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 side = corners[(k + 1) % 3] - corners[k];
        const double along = std::clamp(dot(p - corners[k], side) / dot(side, side), 0.0, 1.0);
        const Vec3 off = p - corners[k] - along * side;
        least = std::min(least, dot(off, off));
        inside = inside && dot(cross(side, p - corners[k]), normal) >= 0;
    }
    return inside ? height * height : least;
}

/// Where a line along z through (x, y) crosses the shape's surface.
void append_crossings(double x, double y, std::vector<Vec3>& points) {
    constexpr double step = 0.0005;
    const int steps = static_cast<int>((liver_bounds.hi[2] - liver_bounds.lo[2]) / step);
    double before = liver_shape({x, y, liver_bounds.lo[2]});
    for (int k = 1; k <= steps; ++k) {
        const double z = liver_bounds.lo[2] + k * step;
        const double now = liver_shape({x, y, z});
        if ((before < 0) != (now < 0)) { points.push_back({x, y, z - step * now / (now - before)}); }
        before = now;
    }
}

std::vector<Vec3> shape_points() {
    std::vector<Vec3> points;
    for (int i = -11; i <= 11; ++i) {
        for (int j = -6; j <= 6; ++j) {
            append_crossings(0.011 * i, 0.011 * j, points);
        }
    }
    return points;
}

/// How often a line from inside the right lobe along x, below the left one, enters the tissue again, in
/// steps.
int count_returns(double y, double z) {
    int returns = 0;
    bool left = false;
    for (int i = -60; i <= 80; ++i) {
        const bool inside = liver_shape({0.0005 * i, -y, z}) < 0;
        returns += left && inside ? 1 : 0;
        left = left || !inside;
    }
    return returns;
}

double rms_to_mesh(const Body& body) {
    const auto triangles = surface_of(body);
    const auto points = shape_points();
    double sum = 0;
    for (const Vec3& p : points) {
        double least = 1;
        for (const auto& [a, b, c] : triangles) {
            const auto& nodes = body.material.nodes;
            const Vec3 off = p - nodes[row(a)];
            if (dot(off, off) > 0.02 * 0.02) { continue; } // far beyond the largest triangle
            least = std::min(least, squared_distance(p, {nodes[row(a)], nodes[row(b)], nodes[row(c)]}));
        }
        sum += least;
    }
    return std::sqrt(sum / static_cast<double>(points.size()));
}

} // namespace

TEST_CASE("the liver of the paper has exactly 6097 elements at every stored refinement") {
    for (int refine = 0; refine <= 2; ++refine) {
        CAPTURE(refine);
        CHECK(made(make_liver({.elements = 6097, .refine = refine})).elements.tets.size() == 6097);
    }
}

TEST_CASE("the liver of 6097 elements is consistent, in one piece, and cut by its boundary") {
    const Body liver = made(make_liver({.elements = 6097}));
    check_lattice_body(liver);
    CHECK(liver.notes.empty());
    const MeshInfo info = measure_body(liver);
    CHECK(info.components == 1);
    CHECK(info.elements_partial >= 0.4 * 6097);
    CHECK(info.fraction_min > 1e-6);
    CHECK(info.volume == doctest::Approx(1.6947e-3).epsilon(0.005));
    CHECK(info.volume_max == doctest::Approx(std::pow(liver.lattice_spacing, 3) / 12));
}

TEST_CASE("the liver is as large as it is said to be") {
    const Body liver = made(make_liver({.elements = 6097}));
    std::set<Index> used;
    for (const Triangle& triangle : surface_of(liver)) {
        used.insert(triangle.begin(), triangle.end());
    }
    Box box = {{1, 1, 1}, {-1, -1, -1}};
    for (const Index vertex : used) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = std::min(box.lo[axis], liver.material.nodes[row(vertex)][axis]);
            box.hi[axis] = std::max(box.hi[axis], liver.material.nodes[row(vertex)][axis]);
        }
    }
    const Vec3 size = box.hi - box.lo;
    CHECK(std::abs(size[0] - 0.24) < 0.01);
    CHECK(std::abs(size[1] - 0.13) < 0.01);
    CHECK(std::abs(size[2] - 0.15) < 0.01);
}

TEST_CASE("the refined liver's surface lies within a millimetre of its shape, both ways") {
    const Body liver = made(make_liver({.elements = 6097, .refine = 2}));
    check_lattice_body(liver);
    const double there = rms_to_shape(liver);
    const double back = rms_to_mesh(liver);
    MESSAGE("surface to shape ", there * 1e3, " mm, shape to surface ", back * 1e3, " mm");
    CHECK(there < 1e-3);
    CHECK(back < 1e-3);
}

TEST_CASE("no peg hangs at the hilum: a line from the right lobe leaves the tissue once") {
    int returns = 0;
    for (int j = -10; j <= 50; ++j) {
        for (int k = -60; k <= -20; ++k) {
            returns += count_returns(0.001 * j, 0.001 * k);
        }
    }
    CHECK(returns == 0);
}

TEST_CASE("the number of liver elements asked for is met within one in a hundred") {
    for (const Index elements : {500, 1000, 3000, 20000}) {
        CAPTURE(elements);
        const Body liver = made(make_liver({.elements = elements}));
        CHECK(std::abs(static_cast<Index>(liver.elements.tets.size()) - elements) * 100 <= elements);
    }
}

TEST_CASE("the liver is the same bit for bit each time it is made") {
    const Body one = made(make_liver({.elements = 1500}));
    const Body two = made(make_liver({.elements = 1500}));
    CHECK(one.elements.nodes == two.elements.nodes);
    CHECK(one.elements.tets == two.elements.tets);
    CHECK(one.material.nodes == two.material.nodes);
    CHECK(one.material.tets == two.material.tets);
    CHECK(one.element_of == two.element_of);
}

TEST_CASE("a preset asks for elements only") {
    CHECK(refusal_of(make_liver({.elements = 6097, .spacing = 0.02})).find("exactly one") !=
          std::string::npos);
}
