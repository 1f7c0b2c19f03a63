// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "fem/kernels.hpp"
#include "mesh/tet.hpp"

namespace resect {

/// Tets (a, b, c_j, c_j+1) round an edge ab, all positive.
struct Fan {
    Index length = 0;                             // tets
    bool closed = false;                          // c_length is c_0
    std::array<Index, 3 + fan_longest> node = {}; // a, b, c_0, c_1, ...
    std::array<Index, fan_longest> tet = {};      // rows of what was covered
};

/// Covers tets by fans, each tet once, in the order of the first tet of each: long fans and long edges go
/// first. `at` are node positions.
std::vector<Fan> cover_with_fans(std::span<const Tet> tets, std::span<const Vec3f> at);

} // namespace resect
