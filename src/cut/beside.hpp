// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cut/cutter_state.hpp"

// Which copies meet across the faces of their elements: what nodes and pieces are derived from.
namespace resect {

inline constexpr Index no_copy = -1, several_copies = -2;

/// [face of the element] The copy that material links join to this one, or no_copy, or several_copies.
std::array<Index, 4> find_beside(const Cutter& cutter, Index copy);

/// Calls visit(copy) for every copy across a face; several may come more than once.
template <class Visit>
void each_beside(const Cutter& cutter, Index copy, std::size_t face, Visit visit) {
    const Index beside = cutter.beside[row(copy)][face];
    if (beside >= 0) { visit(beside); }
    if (beside != several_copies) { return; }
    for (Index m = cutter.first_tet[row(copy)]; m >= 0; m = cutter.material.tet(m).next) {
        const MaterialTet& tet = cutter.material.tet(m);
        for (std::size_t k = 0; k < 4; ++k) {
            if (tet.link[k] < 0 || tet.element_face[k] != static_cast<int>(face)) { continue; }
            visit(cutter.material.tet(tet_of(tet.link[k])).copy);
        }
    }
}

} // namespace resect
