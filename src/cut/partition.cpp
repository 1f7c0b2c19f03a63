// SPDX-License-Identifier: Apache-2.0
#include "cut/partition.hpp"

#include <algorithm>
#include <numeric>

namespace resect {
namespace {

Index find_root(std::vector<Index>& parent, Index at) {
    while (parent[row(at)] != at) {
        parent[row(at)] = parent[row(parent[row(at)])];
        at = parent[row(at)];
    }
    return at;
}

void join(std::vector<Index>& parent, Index a, Index b) {
    a = find_root(parent, a);
    b = find_root(parent, b);
    parent[row(std::max(a, b))] = std::min(a, b);
}

} // namespace

std::vector<Index> label_pairs(const Cutter& cutter) {
    std::vector<Index> parent(4 * cutter.mesh.copy_element.size());
    std::iota(parent.begin(), parent.end(), 0);
    for (const MaterialTet& tet : cutter.material.tets) {
        for (std::size_t k = 0; k < 4; ++k) {
            if (tet.link[k] < 0) { continue; }
            const Index other = cutter.material.tet(tet_of(tet.link[k])).copy;
            if (other <= tet.copy) { continue; }
            for (std::size_t corner = 0; corner < 4; ++corner) {
                if (Index(corner) == tet.element_face[k]) { continue; }
                const Index reference = cutter.element(tet.copy)[corner];
                const std::size_t twin = corner_of(cutter.element(other), reference);
                if (twin < 4) { join(parent, make_link(tet.copy, corner), make_link(other, twin)); }
            }
        }
    }
    for (std::size_t i = 0; i < parent.size(); ++i) {
        parent[i] = find_root(parent, static_cast<Index>(i));
    }
    return parent;
}

} // namespace resect
