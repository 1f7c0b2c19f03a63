// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <doctest/doctest.h>

#include "base/vec.hpp"
#include "mesh/implicit.hpp"

using namespace resect;

TEST_CASE("smooth least and greatest are the plain ones where the values are far apart") {
    CHECK(smooth_min(1, 3, 0.5) == 1);
    CHECK(smooth_max(1, 3, 0.5) == 3);
}

TEST_CASE("smooth least lies a quarter of the width below equal values, smooth greatest as far above") {
    CHECK(smooth_min(2, 2, 0.4) == doctest::Approx(1.9));
    CHECK(smooth_max(2, 2, 0.4) == doctest::Approx(2.1));
    CHECK(smooth_min(2, 2.1, 0.4) == smooth_min(2.1, 2, 0.4));
}

TEST_CASE("a quarter turn about y takes z to x, and about z takes x to y") {
    const Vec3 turned_y = rotate_y({0, 2, 1}, 90);
    CHECK(length(turned_y - Vec3{1, 2, 0}) < 1e-15);
    const Vec3 turned_z = rotate_z({1, 0, 3}, 90);
    CHECK(length(turned_z - Vec3{0, 1, 3}) < 1e-15);
}

TEST_CASE("an ellipsoid is zero on its axes' ends, a distance near them, and finite at its centre") {
    const Vec3 centre = {1, 2, 3};
    const Vec3 radii = {0.5, 0.25, 0.125};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3 p = centre;
        p[axis] += radii[axis];
        CHECK(std::abs(ellipsoid(p, centre, radii)) < 1e-15);
        p[axis] += 0.001;
        CHECK(ellipsoid(p, centre, radii) == doctest::Approx(0.001).epsilon(0.02));
    }
    CHECK(ellipsoid(centre, centre, radii) == -0.125);
}

TEST_CASE("a capsule is a distance to a segment") {
    CHECK(capsule({0.5, 2, 0}, {}, {1, 0, 0}, 0.5) == doctest::Approx(1.5));
    CHECK(capsule({-3, 0, 0}, {}, {1, 0, 0}, 0.5) == doctest::Approx(2.5));
    CHECK(capsule({1, 0, 4}, {}, {1, 0, 0}, 0.5) == doctest::Approx(3.5));
    CHECK(capsule({0.5, 0, 0}, {}, {1, 0, 0}, 0.5) == doctest::Approx(-0.5));
}
