// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "resect/commands.hpp"

#include "base/vec.hpp"
#include "cut/edge_map.hpp"

namespace resect {

/// Axes that move with a blade: `along` from the tip to the heel, the other two across.
struct BladeFrame {
    Vec3 tip = {}, across1 = {}, across2 = {}, along = {};
    double length = 0; // m
};

/// A pose that can cut: finite and of some length.
bool is_sound(const Edge& pose);

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
    double t = 0;     // from the edge's lower vertex
    Vec3 normal = {}; // of the sheet, at rest
};

/// A blade and its stroke, which lasts from placing to lifting.
struct Blade {
    bool placed = false;
    Index stroke = 0; // 1, 2, ... over all blades of a cutter
    BladeFrame frame = {};
    EdgeMap<Crossing> pending = {}; // of this stroke, not bisected yet
    std::vector<Index> sheet = {};  // [vertex] last stroke of this blade whose sheet holds the vertex
    std::vector<Vec3> normal = {};  // [vertex] of that sheet, at rest
};

inline bool is_zero(const Blade& blade, Index vertex) { return blade.sheet[row(vertex)] == blade.stroke; }

} // namespace resect
