// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "resect/commands.hpp"

#include "base/vec.hpp"
#include "cut/edge_map.hpp"
#include "cut/rows.hpp"

namespace resect {

/// Axes that move with a blade: `along` from the tip to the heel, the other two across.
struct BladeFrame {
    Vec3 tip = {}, across1 = {}, across2 = {}, along = {};
    double length = 0; // m
};

/// A pose that can cut: finite and of some length.
bool is_sound(const Edge& pose);

/// Of a point from the blade's edge, m.
double distance_to(const Edge& pose, const Vec3& point);

BladeFrame make_frame(const Edge& pose);
/// The frame at `pose`, turned from `frame` by the smallest rotation that turns the edge.
BladeFrame carry_frame(const BladeFrame& frame, const Edge& pose);

/// Coordinates (across1, across2, along) of a point.
inline Vec3 to_frame(const BladeFrame& frame, const Vec3& point) {
    const Vec3 r = point - frame.tip;
    return {dot(r, frame.across1), dot(r, frame.across2), dot(r, frame.along)};
}

/// Where a blade crossed an edge of the material.
struct Crossing {
    double t = 0;         // from the edge's lower vertex
    double height = 0;    // m above the tip; below it the crossing is soft until the cut reaches it
    bool is_soft = false; // beyond the tip: counts only once promoted
    double expires = 0;   // travel of the blade, m, after which it counts no more
    Vec3 normal = {};     // of the sheet, at rest
};

/// A vertex on the sheet of a stroke.
struct SheetMark {
    Index stroke = 0;
    double expires = 0; // travel of the blade, m, after which it counts no more
    Vec3 normal = {};   // of the sheet, at rest
};

/// Groups of nodes that the elements of a block hang on (near.cpp).
struct BlockGroups {
    std::array<Index, 15> group = {};
    std::uint8_t count = 0;
    bool is_mixed = false; // and others
};

/// How long elements are too far from the blade to be cut (near.cpp). Not part of the state: it can be found
/// anew at any time.
struct Approach {
    double moved = 0; // m, bound on the motion of blade and tissue towards each other so far
    std::vector<double> safe_until = {}; // [place in near_order] value of `moved` up to which it cannot meet
    std::vector<double> block_safe_until = {}; // the least of each block of places
    std::vector<std::uint8_t> is_open = {};    // [block] 1: its elements are looked at one by one
};

/// A blade and its stroke, which lasts from placing to lifting, and longer if a blade takes it over.
struct Blade {
    bool placed = false;
    Index stroke = 0; // 1, 2, ... over all blades of a cutter
    BladeFrame frame = {};
    double travel = 0;               // m, past the tissue around the blade, in this stroke before `step`
    double step = 0;                 // m, of the present increment
    EdgeMap<Crossing> pending = {};  // of this stroke, not bisected yet
    Rows<SheetMark> sheet = {};      // [vertex]
    std::vector<Index> waiting = {}; // tets that others bisected among its crossings, to look at
    Approach approach = {};
};

inline bool is_zero(const Blade& blade, Index vertex) {
    const SheetMark& mark = blade.sheet[row(vertex)];
    return mark.stroke == blade.stroke && blade.travel <= mark.expires;
}

/// The crossing of an edge that has not expired, or null.
inline const Crossing* find_crossing(const Blade& blade, Index u, Index w) {
    const Crossing* found = blade.pending.find(u, w);
    return found != nullptr && blade.travel <= found->expires ? found : nullptr;
}

} // namespace resect
