// SPDX-License-Identifier: Apache-2.0
// Openings of cut blocks that CalculiX 2.20 finds, by find_reference_opening(). Stored, because the fine ones
// take minutes; tests/lab repeats coarse ones, `resect lab references` all of them.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "lab/methods.hpp"

namespace lab {

/// Depth, m, and opening, m: ten-node tets on a conforming mesh of 20 x 4 x 20 cells.
inline constexpr std::pair<double, double> reference_openings[] = {
    {0.005, 0.0000755}, {0.01, 0.0003352}, {0.02, 0.0014117}, {0.03, 0.0033829}, {0.05, 0.0125814}};

/// The same of a notch of 0.025 m that leans by its depth, m.
inline constexpr double leaning_opening = 0.0022098;

/// The same of a block that is split into the side that holds it (split_into_wall), m.
inline constexpr double wall_opening = 0.0063989;

/// Cells along the longer edges, and opening, m: four-node tets on conforming meshes.
using Conforming = std::array<std::pair<resect::Index, double>, 4>;
inline constexpr Conforming conforming_openings = {
    {{4, 0.0067699}, {6, 0.0083413}, {8, 0.0093490}, {12, 0.0105023}}}; // depth 0.05 m
inline constexpr Conforming leaning_conforming_openings = {
    {{4, 0.0010678}, {8, 0.0015658}, {12, 0.0018015}, {16, 0.0019280}}};
inline constexpr Conforming wall_conforming_openings = {
    {{4, 0.0009130}, {8, 0.0026813}, {12, 0.0039695}, {16, 0.0047554}}};

/// Of a depth that is listed.
constexpr double reference_opening(double depth) {
    return std::find_if(std::begin(reference_openings), std::end(reference_openings),
                        [&](const auto& one) { return one.first == depth; })
        ->second;
}

/// A number that is stored above, and the problem whose opening it is.
struct StoredReference {
    std::string name = {};
    double stored = 0; // m
    Problem problem;
    bool quadratic = false;
};

std::vector<StoredReference> list_references();

} // namespace lab
