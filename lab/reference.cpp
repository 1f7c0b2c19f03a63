// SPDX-License-Identifier: Apache-2.0
#include "lab/reference.hpp"

#include <fmt/format.h>

namespace lab {

using namespace resect;

namespace {

constexpr std::array<Index, 3> fine = {20, 4, 20}; // cells

} // namespace

std::vector<StoredReference> list_references() {
    std::vector<StoredReference> list;
    const auto add = [&](const std::string& name, double stored, Problem problem, bool quadratic) {
        list.push_back({name, stored, std::move(problem), quadratic});
    };
    const auto add_conforming = [&](const char* name, const Conforming& openings, auto make) {
        for (const auto& [cells, opening] : openings) {
            add(fmt::format("{}, {} cells, four-node", name, cells), opening, make(block_cells(cells)),
                false);
        }
    };
    const Notch half = {.jitter = 0};
    const Notch leaning = {.depth = 0.025, .lean = 0.025, .jitter = 0};
    add_conforming("notch", conforming_openings, [&](const auto& cells) { return hang_block(cells, half); });
    add_conforming("leaning notch", leaning_conforming_openings,
                   [&](const auto& cells) { return hang_block(cells, leaning); });
    add_conforming("wall", wall_conforming_openings,
                   [](const auto& cells) { return split_into_wall(cells); });
    for (const auto& [depth, opening] : reference_openings) {
        add(fmt::format("notch of {:g} mm, ten-node", 1e3 * depth), opening,
            hang_block(fine, {.depth = depth, .jitter = 0}), true);
    }
    add("leaning notch, ten-node", leaning_opening, hang_block(fine, leaning), true);
    add("wall, ten-node", wall_opening, split_into_wall(fine), true);
    return list;
}

} // namespace lab
