// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <utility>

#include "mesh/adjacency.hpp"
#include "mesh/made.hpp"
#include "mesh/validate.hpp"

using namespace resect;

namespace {

TetMesh small_block() { return made(make_block({0.1, 0.1, 0.1}, {2, 2, 2})).elements; }

/// What the mesh is refused with; empty if it is not.
std::string refusal(TetMesh mesh) { return refusal_of(mend_and_validate(mesh)); }

bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("a good mesh is accepted without notes and left as it is") {
    TetMesh mesh = small_block();
    const auto tets = mesh.tets;
    const auto notes = made(mend_and_validate(mesh));
    CHECK(notes.empty());
    CHECK(mesh.tets == tets);
}

TEST_CASE("a wholly inverted mesh is turned, with a note") {
    TetMesh mesh = small_block();
    for (Tet& tet : mesh.tets) {
        std::swap(tet[0], tet[1]);
    }
    const auto notes = made(mend_and_validate(mesh));
    REQUIRE(notes.size() == 1);
    CHECK(says(notes[0], "all 48 tets were inverted"));
    for (const Tet& tet : mesh.tets) {
        CHECK(signed_volume(mesh, tet) > 0);
    }
}

TEST_CASE("a mesh with some inverted tets is refused with their number and the first row") {
    TetMesh mesh = small_block();
    std::swap(mesh.tets[7][0], mesh.tets[7][1]);
    std::swap(mesh.tets[9][2], mesh.tets[9][3]);
    const std::string why = refusal(mesh);
    CHECK(says(why, "2 of 48 tets are inverted"));
    CHECK(says(why, "tet 7 "));
}

TEST_CASE("an empty mesh is refused") {
    CHECK(says(refusal({}), "empty"));
    TetMesh nodes_only = small_block();
    nodes_only.tets.clear();
    CHECK(says(refusal(nodes_only), "empty"));
}

TEST_CASE("coordinates that are not finite are refused by node") {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        TetMesh mesh = small_block();
        mesh.nodes[5][2] = bad;
        CHECK(says(refusal(mesh), "node 5 has a coordinate that is not finite"));
    }
}

TEST_CASE("rows of nodes out of range are refused by tet and row") {
    for (const Index bad : {-1, 27, 2'000'000'000}) {
        TetMesh mesh = small_block();
        mesh.tets[3][1] = bad;
        const std::string why = refusal(mesh);
        CHECK(says(why, "tet 3 "));
        CHECK(says(why, ("names node " + std::to_string(bad)).c_str()));
        CHECK(says(why, "0 to 26"));
    }
}

TEST_CASE("a tet that repeats a node is refused as degenerate") {
    TetMesh mesh = small_block();
    mesh.tets[4][3] = mesh.tets[4][0];
    CHECK(says(refusal(mesh), "repeats node"));
}

TEST_CASE("a tet without volume is refused as degenerate with its volume and edge") {
    TetMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1e-8}}, {{0, 1, 2, 3}}};
    CHECK(says(refusal(mesh), "degenerate: volume"));
    mesh.nodes[3][2] = 1e-4;
    CHECK(refusal(mesh).empty());
}

TEST_CASE("a duplicated tet is refused with both rows, however its corners are ordered") {
    TetMesh mesh = small_block();
    const Tet& tet = mesh.tets[11];
    mesh.tets.push_back({tet[1], tet[2], tet[0], tet[3]});
    const std::string why = refusal(mesh);
    CHECK(says(why, "tet 48 "));
    CHECK(says(why, "duplicate of tet 11"));
}

TEST_CASE("a face of three tets is refused") {
    const TetMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0.1, 0.1, 2}},
                          {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}}};
    CHECK(says(refusal(mesh), "shared by 3 tets"));
}

TEST_CASE("two tets on one side of their face are refused as overlapping") {
    const TetMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 2}},
                          {{0, 1, 2, 3}, {0, 1, 2, 4}}};
    CHECK(says(refusal(mesh), "overlap"));
}

TEST_CASE("a tet that shares no face is refused, and larger separate pieces are noted") {
    TetMesh mesh = small_block();
    const Index first = static_cast<Index>(mesh.nodes.size());
    mesh.nodes.insert(mesh.nodes.end(), {{1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}, {1, 0, -1}});
    mesh.tets.push_back({first, first + 1, first + 2, first + 3});
    CHECK(says(refusal(mesh), "tet 48 (nodes 27 28 29 30) is disconnected"));
    mesh.tets.push_back({first, first + 2, first + 1, first + 4});
    const auto notes = made(mend_and_validate(mesh));
    REQUIRE(notes.size() == 1);
    CHECK(says(notes[0], "2 separate components, of 48, 2 tets"));
}

TEST_CASE("a single tet is a whole mesh") {
    CHECK(refusal({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}}).empty());
}

TEST_CASE("nodes of no tet are kept and noted") {
    TetMesh mesh = small_block();
    mesh.nodes.push_back({5, 5, 5});
    const auto notes = made(mend_and_validate(mesh));
    REQUIRE(notes.size() == 1);
    CHECK(says(notes[0], "1 nodes belong to no tet, first node 27"));
    CHECK(mesh.nodes.size() == 28);
}
