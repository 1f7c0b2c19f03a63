// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <doctest/doctest.h>
#include <vector>

#include "base/hash.hpp"
#include "base/vec.hpp"

using namespace resect;

TEST_CASE("the cross product is at right angles to both") {
    const Vec3 a{1, 2, 3}, b{-2, 0.5, 4};
    CHECK(dot(cross(a, b), a) == 0);
    CHECK(dot(cross(a, b), b) == 0);
    CHECK(length(cross(Vec3{1, 0, 0}, Vec3{0, 1, 0})) == 1);
}

TEST_CASE("a zero vector has no direction") {
    CHECK(direction(Vec3{}) == Vec3{});
    CHECK(length(direction(Vec3{3, 4, 12})) == doctest::Approx(1));
}

TEST_CASE("boxes are closed") {
    const Box box{{0, 0, 0}, {1, 1, 1}};
    CHECK(is_inside(box, {0, 1, 0.5}));
    CHECK_FALSE(is_inside(box, {0, 1 + 1e-15, 0.5}));
    CHECK_FALSE(is_inside(box, {std::nan(""), 0, 0}));
}

TEST_CASE("hashes tell values, order and the sign of zero apart") {
    const auto of = [](const std::vector<double>& v) {
        return Hash().add(std::span<const double>(v)).value();
    };
    CHECK(of({1, 2}) == of({1, 2}));
    CHECK(of({1, 2}) != of({2, 1}));
    CHECK(of({0}) != of({-0.0}));
    CHECK(of({0}) != of({0, 0}));
    CHECK(Hash().add(Vec3f{1, 2, 3}).value() != Hash().add(Vec3f{1, 2, 4}).value());
}
