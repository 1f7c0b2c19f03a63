// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>

#include "base/index.hpp"
#include "mesh/made.hpp"
#include "mesh/quality.hpp"
#include "mesh/tet.hpp"
#include "mesh/validate.hpp"

using namespace resect;

namespace {

Index corner_row(Index x, Index y, Index z, std::array<Index, 3> cells) {
    return x + (cells[0] + 1) * (y + (cells[1] + 1) * z);
}

} // namespace

TEST_CASE("a Kuhn block numbers its nodes x fastest, then y, then z") {
    const Body block = made(make_block({0.3, 0.2, 0.1}, {3, 2, 2}));
    REQUIRE(block.elements.nodes.size() == 36);
    const Vec3& node = block.elements.nodes[row(corner_row(1, 2, 1, {3, 2, 2}))];
    CHECK(length(node - Vec3{0.1, 0.2, 0.05}) < 1e-15);
}

TEST_CASE("a Kuhn block orders the six tets of a cell by the order of the axes") {
    const std::array<Index, 3> cells = {3, 2, 2};
    const Body block = made(make_block({0.3, 0.2, 0.1}, cells));
    REQUIRE(block.elements.tets.size() == 72);
    const auto at = [&](Index x, Index y, Index z) { return corner_row(x, y, z, cells); };
    // The first cell's, in which odd orders have their last two corners swapped; the next cell lies along x.
    const std::vector<Tet> expected = {{at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(1, 1, 1)},
                                       {at(0, 0, 0), at(1, 0, 0), at(1, 1, 1), at(1, 0, 1)},
                                       {at(0, 0, 0), at(0, 1, 0), at(1, 1, 1), at(1, 1, 0)},
                                       {at(0, 0, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1)},
                                       {at(0, 0, 0), at(0, 0, 1), at(1, 0, 1), at(1, 1, 1)},
                                       {at(0, 0, 0), at(0, 0, 1), at(1, 1, 1), at(0, 1, 1)},
                                       {at(1, 0, 0), at(2, 0, 0), at(2, 1, 0), at(2, 1, 1)}};
    CHECK(std::equal(expected.begin(), expected.end(), block.elements.tets.begin()));
}

TEST_CASE("blocks of both splits are valid meshes of conforming elements") {
    for (const Split split : {Split::six, Split::bcc}) {
        CAPTURE(static_cast<int>(split));
        Body block = made(make_block({0.2, 0.05, 0.1}, {4, 3, 5}, split));
        CHECK(made(mend_and_validate(block.elements)).empty());
        CHECK(block.material.tets.empty());
        CHECK(block.lattice_spacing == 0);
    }
}

TEST_CASE("blocks of both splits are whole, of the right volume, and two triangles a boundary face") {
    for (const Split split : {Split::six, Split::bcc}) {
        CAPTURE(static_cast<int>(split));
        const Body block = made(make_block({0.2, 0.05, 0.1}, {4, 3, 5}, split));
        const MeshInfo info = measure_body(block);
        CHECK(info.volume == doctest::Approx(0.001).epsilon(1e-12));
        CHECK(info.components == 1);
        CHECK(info.boundary_triangles == 2 * 2 * (4 * 3 + 3 * 5 + 5 * 4));
    }
}

TEST_CASE("a body-centred block has four tets at each inner face of its cells and two at each outer one") {
    const Body block = made(make_block({1, 1, 1}, {2, 3, 4}, Split::bcc));
    const int inner = 1 * 3 * 4 + 2 * 2 * 4 + 2 * 3 * 3;
    const int outer = 2 * (2 * 3 + 3 * 4 + 4 * 2);
    CHECK(block.elements.tets.size() == 4 * inner + 2 * outer);
    CHECK(block.elements.nodes.size() == 3 * 4 * 5 + 2 * 3 * 4);
    CHECK(block.elements.nodes[60][2] == doctest::Approx(0.125)); // the first centre
}

TEST_CASE("a block without extent, without cells or too large is refused with its numbers") {
    const double inf = std::numeric_limits<double>::infinity();
    for (const Vec3& size : {Vec3{0, 1, 1}, Vec3{1, -1, 1}, Vec3{1, 1, inf}, Vec3{std::nan(""), 1, 1}}) {
        const std::string block = refusal_of(make_block(size, {1, 1, 1}));
        CHECK(block.find("finite and above 0") != std::string::npos);
    }
    const std::string no_cells = refusal_of(make_block({1, 1, 1}, {1, 0, 1}));
    CHECK(no_cells.find("(1, 0, 1)") != std::string::npos);
    for (const Split split : {Split::six, Split::bcc}) {
        const std::string large =
            refusal_of(make_block({1, 1, 1}, {2'000'000'000, 2'000'000'000, 2'000'000'000}, split));
        CHECK(large.find("fewer cells") != std::string::npos);
    }
}
