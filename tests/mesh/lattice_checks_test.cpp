// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <map>

#include "mesh/adjacency.hpp"
#include "mesh/lattice_checks.hpp"
#include "mesh/quality.hpp"

namespace resect {
namespace {

/// Least barycentric weight of p in a tet, that is its least signed corner volume over the whole.
double least_weight(const TetMesh& mesh, const Tet& tet, const Vec3& p) {
    double least = 1;
    for (std::size_t k = 0; k < 4; ++k) {
        std::array<Vec3, 4> corners = {};
        for (std::size_t j = 0; j < 4; ++j) {
            corners[j] = j == k ? p : mesh.nodes[row(tet[j])];
        }
        const double part = signed_volume(corners[0], corners[1], corners[2], corners[3]);
        least = std::min(least, part / signed_volume(mesh, tet));
    }
    return least;
}

/// Each element has the lengths of a body-centred lattice tet: two edges a, four edges a sqrt(3) / 2.
void check_congruence(const Body& body) {
    const double a = body.lattice_spacing;
    double worst = 0;
    for (const Tet& tet : body.elements.tets) {
        std::array<double, 6> lengths = {};
        std::transform(std::begin(edge_corners), std::end(edge_corners), lengths.begin(),
                       [&](const auto& edge) {
                           return length(body.elements.nodes[row(tet[row(edge[0])])] -
                                         body.elements.nodes[row(tet[row(edge[1])])]);
                       });
        std::sort(lengths.begin(), lengths.end());
        for (std::size_t k = 0; k < 6; ++k) {
            worst = std::max(worst, std::abs(lengths[k] / a - (k < 4 ? std::sqrt(0.75) : 1)));
        }
        worst = std::max(worst, std::abs(signed_volume(body.elements, tet) / (a * a * a / 12) - 1));
    }
    CHECK(worst < 1e-12);
}

/// Material lies in the elements that it names, and none is empty.
void check_embedding(const Body& body) {
    CHECK(std::equal(body.elements.nodes.begin(), body.elements.nodes.end(), body.material.nodes.begin()));
    std::vector<char> holds(body.elements.tets.size(), 0);
    double least = 1;
    for (std::size_t tet = 0; tet < body.material.tets.size(); ++tet) {
        const Index element = body.element_of[tet];
        holds[row(element)] = 1;
        for (const Index vertex : body.material.tets[tet]) {
            const Vec3& p = body.material.nodes[row(vertex)];
            least = std::min(least, least_weight(body.elements, body.elements.tets[row(element)], p));
        }
    }
    CHECK(least >= -1e-12);
    CHECK(std::count(holds.begin(), holds.end(), 0) == 0);
}

void check_no_tiny_tet(const Body& body) {
    double least = 1;
    for (const Tet& tet : body.material.tets) {
        least = std::min(least, signed_volume(body.material, tet));
    }
    CHECK(least > 1e-9 * signed_volume(body.elements, body.elements.tets[0]));
}

/// Faces have one tet or two, seen from opposite sides.
void check_faces(const TetMesh& mesh) {
    const FaceGroups groups = build_face_groups(mesh);
    int wrong = 0;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const auto slots = groups[i];
        if (slots.size() == 1) { continue; }
        Triangle back = face_nodes(mesh, slots[1]);
        std::swap(back[1], back[2]);
        const Triangle front = face_nodes(mesh, slots[0]);
        std::rotate(back.begin(), std::find(back.begin(), back.end(), front[0]), back.end());
        wrong += slots.size() == 2 && back == front ? 0 : 1;
    }
    CHECK(wrong == 0);
}

/// Each edge is run through as often one way as the other.
void check_closed(const std::vector<Triangle>& triangles) {
    std::map<std::pair<Index, Index>, int> balance;
    for (const Triangle& triangle : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
            balance[{low, high}] += low == triangle[k] ? 1 : -1;
        }
    }
    CHECK(std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; }));
}

void check_volumes(const Body& body, const std::vector<Triangle>& triangles) {
    double enclosed = 0;
    for (const auto& [a, b, c] : triangles) {
        const auto& p = body.material.nodes;
        enclosed += dot(p[row(a)], cross(p[row(b)], p[row(c)])) / 6;
    }
    double held = 0;
    for (const Tet& tet : body.material.tets) {
        held += signed_volume(body.material, tet);
    }
    double shares = 0;
    for (const double fraction : compute_fractions(body)) {
        shares += fraction;
    }
    const double a = body.lattice_spacing;
    CHECK(std::abs(enclosed / held - 1) < 1e-12);
    CHECK(std::abs(shares * a * a * a / 12 / held - 1) < 1e-12);
}

} // namespace

void check_lattice_body(const Body& body) {
    REQUIRE(!body.material.tets.empty());
    check_congruence(body);
    REQUIRE(body.element_of.size() == body.material.tets.size());
    check_embedding(body);
    check_no_tiny_tet(body);
    check_faces(body.elements);
    check_faces(body.material);
    const auto triangles = build_boundary(body.material, build_face_mates(body.material));
    check_closed(triangles);
    check_volumes(body, triangles);
}

} // namespace resect
