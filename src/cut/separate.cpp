// SPDX-License-Identifier: Apache-2.0
#include "cut/separate.hpp"

#include <array>
#include <cstdint>

#include "mesh/tet.hpp"

namespace resect {
namespace {

/// Corners that uncrossed edges between corners of `within` join to those of `side`.
unsigned flood(unsigned side, unsigned within, unsigned crossed) {
    for (int pass = 0; pass < 3; ++pass) {
        for (unsigned e = 0; e < 6; ++e) {
            const unsigned ends = (1U << unsigned(edge_corners[e][0])) | (1U << unsigned(edge_corners[e][1]));
            const bool joins = ((crossed >> e) & 1U) == 0 && (ends & ~within) == 0 && (ends & side) != 0;
            if (joins) { side |= ends; }
        }
    }
    return side;
}

std::array<std::uint8_t, 1024> build_table() {
    std::array<std::uint8_t, 1024> table = {};
    for (unsigned state = 0; state < 1024; ++state) {
        const unsigned off_sheet = ~state & 15U;
        const unsigned lowest = off_sheet & (~off_sheet + 1U);
        const unsigned side = flood(lowest, off_sheet, state >> 4U);
        table[state] = side == off_sheet ? std::uint8_t{0} : static_cast<std::uint8_t>(side);
    }
    return table;
}

} // namespace

unsigned find_side(unsigned zero, unsigned crossed) {
    static const std::array<std::uint8_t, 1024> table = build_table();
    return table[zero | (crossed << 4U)];
}

} // namespace resect
