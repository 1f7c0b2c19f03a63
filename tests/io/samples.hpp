// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "resect/reports.hpp"

namespace resect {

/// A block of 2 x 1 x 1 cells of six tets with coordinates that no decimal of few digits holds, two regions
/// and two node sets that share nodes.
inline Body sample_body() {
    Body body;
    for (int z = 0; z < 2; ++z) {
        for (int y = 0; y < 2; ++y) {
            for (int x = 0; x < 3; ++x) {
                body.elements.nodes.push_back({x / 3.0, -y / 7.0, z * 1e-3 / 9.0});
            }
        }
    }
    const Index cube[6][4] = {{0, 1, 7, 4},  {0, 4, 7, 10}, {0, 1, 10, 7},
                              {0, 6, 7, 10}, {0, 4, 10, 3}, {0, 6, 10, 9}};
    for (const Index x : {0, 1}) {
        for (const auto& tet : cube) {
            std::array<Index, 4> t = {tet[0] + x, tet[1] + x, tet[2] + x, tet[3] + x};
            body.elements.tets.push_back(t);
            body.region.push_back(x);
        }
    }
    body.node_sets = {{"left", {0, 3, 6, 9}}, {"low & <near>", {0, 1, 2}}};
    return body;
}

/// A tetrahedron's boundary, moved, with two vertices at one point; and all the arrays that a surface views.
struct SampleSurface {
    std::vector<Vec3f> position = {{0.1F, 0, 1e-20F},
                                   {1 / 3.0F, 0, 0},
                                   {0, -1e10F / 3, 0},
                                   {0, 0, 16777217.F / 3},
                                   {0, 0, 16777217.F / 3}};
    std::vector<Vec3f> normal = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.6F, 0.8F, 0}, {0, -0.6F, 0.8F}};
    std::vector<Vec3f> rest = {{0, 0, 0}, {0.7F, 0, 0}, {0, 0.7F, 0}, {0, 0, 0.7F}, {0, 0, 0.7F}};
    std::vector<Index> point = {7, 2, 9, 4, 4};
    std::vector<std::array<Index, 3>> triangle = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 4}};
    std::vector<Index> face = {0, 1, -1, 0}, piece = {3, 3, 4, 4};

    Surface view() const {
        Surface surface;
        surface.position = position;
        surface.normal = normal;
        surface.rest = rest;
        surface.point = point;
        surface.triangle = triangle;
        surface.face = face;
        surface.piece = piece;
        return surface;
    }

    /// The same with a point for each vertex.
    Surface split() const {
        Surface surface = view();
        surface.point = {};
        return surface;
    }
};

/// Two copies that share a face, with different values in all fields.
struct SampleCopies {
    std::vector<Vec3f> rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1 / 3.0F}, {1, 1, 1}};
    std::vector<Vec3f> displacement = {{0.1F, 0, 0}, {0, 0.2F, 0}, {0, 0, 0.3F}, {1e-30F, 0, 0}, {-7, 0, 0}};
    std::vector<Vec3f> velocity = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}, {13, 14, 1e30F}};
    std::vector<float> mass = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F};
    std::vector<double> fraction = {0.25, 1 / 3.0};
    std::vector<std::uint8_t> fixed = {1, 0, 0, 1, 0};
    std::vector<Index> reference = {5, 4, 3, 2, 5}, element = {9, 9}, piece = {1, 2};
    std::vector<std::array<Index, 4>> node = {{0, 1, 2, 3}, {1, 2, 3, 4}};
    std::vector<double> von_mises = {1.0 / 3, 2e300};

    Nodes nodes() const { return {rest, displacement, velocity, mass, fixed, reference}; }
    Copies copies() const { return {node, element, piece, fraction}; }
};

} // namespace resect
