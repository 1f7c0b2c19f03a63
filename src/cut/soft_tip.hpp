// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cut/cutter_state.hpp"

namespace resect {

/// A tet that crossings separate: bits of the corners on one side, and of those on the sheet.
struct Separation {
    unsigned side = 0, zero = 0;
};

/// Calls visit(a, b) for the corners of each crossed edge between the two sides.
template <class Visit>
void each_parted_edge(const Separation& parted, Visit visit) {
    for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = 0; b < 4; ++b) {
            const bool is_parted =
                ((parted.side >> a) & 1U) != 0 && (((parted.side | parted.zero) >> b) & 1U) == 0;
            if (is_parted) { visit(a, b); }
        }
    }
}

/// Whether enough of the section of a tet that is separated by crossings beyond the tip too lies above the
/// tip for the tet to be cut through (docs/cutting.md, "Shallow cuts").
bool reaches_deep(const Cutter& cutter, const Blade& blade, const Tet& vertex, const Separation& parted);

} // namespace resect
