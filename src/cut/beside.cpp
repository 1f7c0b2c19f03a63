// SPDX-License-Identifier: Apache-2.0
#include "cut/beside.hpp"

namespace resect {

std::array<Index, 4> find_beside(const Cutter& cutter, Index copy) {
    std::array<Index, 4> beside = {no_copy, no_copy, no_copy, no_copy};
    for (Index m = cutter.first_tet[row(copy)]; m >= 0; m = cutter.material.tet(m).next) {
        const MaterialTet& tet = cutter.material.tet(m);
        for (std::size_t k = 0; k < 4; ++k) {
            if (tet.link[k] < 0 || tet.element_face[k] < 0) { continue; }
            Index& known = beside[row(Index{tet.element_face[k]})];
            const Index other = cutter.material.tet(tet_of(tet.link[k])).copy;
            if (known != other) { known = known == no_copy ? other : several_copies; }
        }
    }
    return beside;
}

} // namespace resect
