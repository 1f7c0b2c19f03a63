// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <doctest/doctest.h>
#include <map>
#include <set>

#include "mesh/adjacency.hpp"
#include "mesh/made.hpp"

using namespace resect;

namespace {

std::set<Index> nodes_of(const TetMesh& mesh, Index slot) {
    const Triangle face = face_nodes(mesh, slot);
    return {face.begin(), face.end()};
}

} // namespace

TEST_CASE("mates are symmetric, share three nodes, and exist for faces of two tets only") {
    const Body block = made(make_block({1, 1, 1}, {3, 2, 4}, Split::bcc));
    const TetMesh& mesh = block.elements;
    const auto mates = build_face_mates(mesh);
    REQUIRE(mates.size() == 4 * mesh.tets.size());
    std::map<std::set<Index>, std::vector<Index>> slots_of;
    for (Index slot = 0; slot < static_cast<Index>(mates.size()); ++slot) {
        slots_of[nodes_of(mesh, slot)].push_back(slot);
    }
    std::vector<Index> expected(mates.size(), no_mate);
    for (const auto& [nodes, slots] : slots_of) {
        if (slots.size() < 2) { continue; }
        expected[row(slots[0])] = slots[1];
        expected[row(slots[1])] = slots[0];
    }
    CHECK(mates == expected);
    CHECK(std::count(mates.begin(), mates.end(), no_mate) == 2 * 2 * (3 * 2 + 2 * 4 + 4 * 3));
}

TEST_CASE("the boundary points outward: the volume it encloses is the mesh's") {
    const Body block = made(make_block({0.5, 0.4, 0.3}, {2, 3, 2}));
    const TetMesh& mesh = block.elements;
    double enclosed = 0;
    for (const auto& [a, b, c] : build_boundary(mesh, build_face_mates(mesh))) {
        enclosed += dot(mesh.nodes[row(a)], cross(mesh.nodes[row(b)], mesh.nodes[row(c)])) / 6;
    }
    CHECK(enclosed == doctest::Approx(0.06).epsilon(1e-12));
}

TEST_CASE("components are numbered by their lowest tet and hang together by faces only") {
    // Tets 0 and 2 share a face; tet 1 touches tet 0 at one edge.
    const TetMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {1, -1, 0}, {1, -1, 1}},
                          {{0, 1, 2, 3}, {0, 5, 1, 6}, {0, 2, 1, 4}}};
    const Components components = build_components(build_face_mates(mesh));
    CHECK(components.of_tet == std::vector<Index>{0, 1, 0});
    CHECK(components.sizes == std::vector<Index>{2, 1});
}

TEST_CASE("a mesh without tets has no faces") {
    const TetMesh mesh = {};
    CHECK(build_face_groups(mesh).size() == 0);
    CHECK(build_face_mates(mesh).empty());
    CHECK(build_components({}).sizes.empty());
}
