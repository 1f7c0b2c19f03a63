// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "cut/stages.hpp"

namespace resect {
namespace {

/// Of six tets that make a cube of one grain the longest edge is the cube's diagonal.
const double longest_of_grain = 1.01 * std::sqrt(3.0);

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

/// Some corners lie on either side of each side of the box, grown by what lies ahead.
bool is_near(const Cutter& cutter, const Sweep& sweep, const BladeBox& box, Index tet) {
    const BladeBox grown = {box.across + box.ahead, box.beyond_tip + box.ahead, box.length + box.ahead};
    unsigned common = 63;
    for (const Index v : cutter.material.tet(tet).vertex) {
        common &= sides_beyond(grown, to_frame(sweep.to, displaced_position(cutter, v, sweep.after)));
    }
    return common == 0;
}

/// The blade's line ran through the tet before the sweep, or has crossed an edge of it in this stroke: edges
/// that come into being inside it could have been crossed without a note.
bool is_begun(const Cutter& cutter, const Blade& blade, const Sweep& sweep, Index tet) {
    const Tet& vertex = cutter.material.tet(tet).vertex;
    std::array<Vec3, 4> p = {};
    for (std::size_t k = 0; k < 4; ++k) {
        p[k] = to_frame(sweep.from, displaced_position(cutter, vertex[k], sweep.before));
    }
    const auto turn_about_blade = [&](int a, int b) {
        return p[row(a)][0] * p[row(b)][1] - p[row(a)][1] * p[row(b)][0];
    };
    for (const auto& [a, b, c] : face_corners) {
        const double ab = turn_about_blade(a, b);
        const double bc = turn_about_blade(b, c);
        const double ca = turn_about_blade(c, a);
        if ((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0)) { return true; }
    }
    for (const auto& [a, b] : edge_corners) {
        if (blade.pending.find(vertex[row(a)], vertex[row(b)]) != nullptr) { return true; }
    }
    return false;
}

bool may_bisect(Cutter& cutter, const Blade& blade, const Sweep& sweep, const MaterialEdge& edge) {
    find_ring(cutter.material, edge, cutter.scratch.walked, cutter.scratch.ring);
    return std::none_of(cutter.scratch.ring.begin(), cutter.scratch.ring.end(),
                        [&](Index tet) { return is_begun(cutter, blade, sweep, tet); });
}

} // namespace

void refine_near(Cutter& cutter, const Blade& blade, const Sweep& sweep, const BladeBox& box) {
    if (box.ahead == 0) { return; }
    std::vector<Index> left;
    for (const Index copy : cutter.scratch.copies_ahead) {
        for (Index m = cutter.first_tet[row(copy)]; m >= 0; m = cutter.material.tet(m).next) {
            left.push_back(m);
        }
    }
    while (!left.empty()) {
        const Index tet = left.back();
        left.pop_back();
        if (cutter.tet_count[row(cutter.element_of(tet))] >= cutter.crowd / 4) { continue; }
        const LongestEdge longest = find_longest_edge(cutter, tet);
        if (longest.length <= longest.wanted || !is_near(cutter, sweep, box, tet)) { continue; }
        if (!may_bisect(cutter, blade, sweep, longest.edge)) { continue; }
        const Index first = cut_edge(cutter, longest.edge, 0.5, {});
        const std::vector<Index>& ring = cutter.scratch.ring;
        left.insert(left.end(), ring.begin(), ring.end());
        for (Index m = first; m < cutter.material.tet_count(); ++m) {
            left.push_back(m);
        }
    }
}

} // namespace resect
