// SPDX-License-Identifier: Apache-2.0
// Openings of the notched hanging block (hang_block) that CalculiX 2.20 finds, by find_reference_opening();
// tests/lab repeats the coarse ones. Stored, because the fine ones take minutes.
#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "resect/body.hpp"

namespace lab {

/// Depth, m, and opening, m: ten-node tets on a conforming mesh of 20 x 4 x 20 cells.
inline constexpr std::pair<double, double> reference_openings[] = {
    {0.005, 0.0000755}, {0.01, 0.0003352}, {0.02, 0.0014117}, {0.03, 0.0033829}, {0.05, 0.0125814}};

/// The same of a notch of 0.025 m that leans by its depth, m.
inline constexpr double leaning_opening = 0.0022098;

/// Cells along the longer edges, and opening, m: four-node tets on conforming meshes.
using Conforming = std::array<std::pair<resect::Index, double>, 4>;
inline constexpr Conforming conforming_openings = {
    {{4, 0.0067699}, {6, 0.0083413}, {8, 0.0093490}, {12, 0.0105023}}}; // depth 0.05 m
inline constexpr Conforming leaning_conforming_openings = {
    {{4, 0.0010678}, {8, 0.0015658}, {12, 0.0018015}, {16, 0.0019280}}};

/// Of a depth that is listed.
constexpr double reference_opening(double depth) {
    return std::find_if(std::begin(reference_openings), std::end(reference_openings),
                        [&](const auto& one) { return one.first == depth; })
        ->second;
}

} // namespace lab
