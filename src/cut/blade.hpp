// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "resect/commands.hpp"

#include "base/vec.hpp"
#include "cut/edge_map.hpp"
#include "cut/near.hpp"
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
