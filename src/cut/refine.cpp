// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "cut/stages.hpp"

namespace resect {
namespace {

/// Of six tets that make a cube of one grain the longest edge is the cube's diagonal.
const double longest_of_grain = 1.01 * std::sqrt(3.0);

/// Material tets of an element that refinement leaves room below, for cuts.
constexpr Index most_refined = 100;

struct LongestEdge {
    MaterialEdge edge = {};
    double length = 0, wanted = 0; // m
};

LongestEdge find_longest_edge(const Cutter& cutter, Index tet) {
    const MaterialMesh& material = cutter.material;
    const Tet& vertex = material.tet(tet).vertex;
    LongestEdge longest;
    for (const auto& [a, b] : edge_corners) {
        const Index u = vertex[row(a)];
        const Index w = vertex[row(b)];
        const double reach = length(material.rest[row(u)] - material.rest[row(w)]);
        if (reach <= longest.length) { continue; }
        const double grain = 0.5 * (material.grain[row(u)] + material.grain[row(w)]);
        longest = {{u, w, tet}, reach, longest_of_grain * grain / (1 << cutter.setup.options.refine)};
    }
    return longest;
}

/// Some corners lie on either side of each side of the box, grown by half a grain.
bool is_near(const Cutter& cutter, const Sweep& sweep, const BladeBox& box, Index tet) {
    const double more = 0.5 * cutter.grain;
    const BladeBox grown = {box.across + more, box.beyond_tip + more, box.length + more};
    unsigned common = 63;
    for (const Index v : cutter.material.tet(tet).vertex) {
        common &= sides_beyond(grown, to_frame(sweep.to, displaced_position(cutter, v, sweep.after)));
    }
    return common == 0;
}

} // namespace

void refine_near(Cutter& cutter, const Sweep& sweep, const BladeBox& box) {
    if (cutter.setup.options.refine == 0) { return; }
    std::vector<Index> left;
    for (const Index copy : cutter.scratch.near_copies) {
        for (Index m = cutter.first_tet[row(copy)]; m >= 0; m = cutter.material.tet(m).next) {
            left.push_back(m);
        }
    }
    while (!left.empty()) {
        const Index tet = left.back();
        left.pop_back();
        if (cutter.tet_count[row(cutter.element_of(tet))] >= most_refined) { continue; }
        const LongestEdge longest = find_longest_edge(cutter, tet);
        if (longest.length <= longest.wanted || !is_near(cutter, sweep, box, tet)) { continue; }
        const Index first = cut_edge(cutter, longest.edge, 0.5, {});
        const std::vector<Index>& ring = cutter.scratch.ring;
        left.insert(left.end(), ring.begin(), ring.end());
        for (Index m = first; m < cutter.material.tet_count(); ++m) {
            left.push_back(m);
        }
    }
}

} // namespace resect
