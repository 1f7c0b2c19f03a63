// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <doctest/doctest.h>

#include "mesh/made.hpp"
#include "mesh/quality.hpp"

using namespace resect;

TEST_CASE("the corner tet of a cube has known angles, altitude and volume") {
    Body body;
    body.elements = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
    const MeshInfo info = measure_body(body);
    CHECK(info.nodes == 4);
    CHECK(info.tets == 1);
    CHECK(info.components == 1);
    CHECK(info.boundary_triangles == 4);
    CHECK(info.volume == doctest::Approx(1.0 / 6));
    CHECK(info.dihedral_max == doctest::Approx(90));
    CHECK(info.dihedral_min == doctest::Approx(std::acos(1 / std::sqrt(3.0)) * 180 / 3.14159265358979));
    CHECK(info.altitude_min == doctest::Approx(1 / std::sqrt(3.0)));
    CHECK(info.fraction_min == 1);
    CHECK(info.elements_partial == 0);
}

TEST_CASE("a block's numbers are those of its cells") {
    const MeshInfo info = measure_body(made(make_block({0.2, 0.1, 0.1}, {4, 2, 2})));
    CHECK(info.tets == 96);
    CHECK(info.boundary_triangles == 2 * (4 + 4 + 8 + 8 + 8 + 8));
    CHECK(info.bounds.hi == Vec3{0.2, 0.1, 0.1});
    CHECK(info.volume == doctest::Approx(0.002));
    CHECK(info.volume_min == doctest::Approx(0.002 / 96));
    CHECK(info.volume_max == doctest::Approx(0.002 / 96));
    CHECK(info.dihedral_min == doctest::Approx(45));
    CHECK(info.altitude_median == doctest::Approx(0.05 / std::sqrt(2.0)));
}

TEST_CASE("material that fills half of one element is a fraction") {
    Body body;
    body.elements = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}}, {{0, 1, 2, 3}, {0, 2, 1, 4}}};
    body.material = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 0, -0.5}},
                     {{0, 1, 2, 3}, {0, 2, 1, 5}}};
    body.element_of = {0, 1};
    CHECK(compute_fractions(body)[1] == doctest::Approx(0.5));
    const MeshInfo info = measure_body(body);
    CHECK(info.fraction_min == doctest::Approx(0.5));
    CHECK(info.elements_partial == 1);
    CHECK(info.volume == doctest::Approx(0.25));
    CHECK(info.volume_min == doctest::Approx(1.0 / 6));
}

TEST_CASE("a body without tets measures nothing") { CHECK(measure_body({}).volume == 0); }
