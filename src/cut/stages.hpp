// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cut/cutter_state.hpp"

// The stages of an increment, in order. They hand on what they found in Cutter::scratch.
namespace resect {

/// A vertex that the blade passes as closely as this share of the local grain lies on the sheet.
inline constexpr double snap_share = 0.03;

struct Sweep {
    BladeFrame from = {}, to = {};
    std::span<const Vec3f> before = {}, after = {}; // displacements, [node]
};

/// The blade with its snapping distance around it and what it sees beyond its tip, in the blade's frame.
struct BladeBox {
    double across = 0, beyond_tip = 0, length = 0; // m
    double ahead = 0;                              // m, how far around the blade material is refined
};

BladeBox make_box(const Cutter& cutter, const Sweep& sweep);
/// A bit for each side of the box that the point lies beyond.
std::uint8_t sides_beyond(const BladeBox& box, const Vec3& point);

/// Lists the copies that may meet the blade.
void find_near_copies(Cutter& cutter, Blade& blade, const Sweep& sweep, const BladeBox& box);

/// Bisects the longest edges of the material that the blade is about to meet until they are as fine as asked
/// for.
void refine_near(Cutter& cutter, const Blade& blade, const Sweep& sweep, const BladeBox& box);

/// Puts vertices that the blade passes closely on its sheet, records crossed edges, queues the tets around
/// both.
void detect_crossings(Cutter& cutter, Blade& blade, const Sweep& sweep, const BladeBox& box,
                      CutReport& report);

/// Bisects the crossed edges of every queued tet that they separate.
void bisect_separated(Cutter& cutter, const Blade& blade);

/// Drops the links across the sheet, but not those that would leave crumbs, and splits vertices.
void tear_sheet(Cutter& cutter, Blade& blade, CutReport& report);

/// Links parts that tear_sheet tore off and that are too small to be meant, each through one face again.
void glue_crumbs(Cutter& cutter, CutReport& report);

/// Splits the vertices of torn faces whose star fell apart, into however many parts.
void part_torn_vertices(Cutter& cutter);

/// Copies, nodes and weights anew around torn faces.
void derive_simulation(Cutter& cutter, Delta& delta, CutReport& report);

/// The first fault in words among the rows that the increment changed, or null: what each row can tell of
/// itself and of its neighbours.
const char* find_fault(const Cutter& cutter);

/// Queues a tet, and notes it as changed.
void queue_tet(Cutter& cutter, Index tet);

/// An edge that has been bisected at z = (1 - t) u + t w: the tets around it are in scratch.ring, their
/// halves at w begin at row `first`.
struct Bisection {
    Index u = 0, w = 0, z = 0;
    double t = 0;
    Index first = 0;
};

/// What another blade than the one that cuts makes of it.
void hand_down(Cutter& cutter, Blade& blade, const Bisection& cut);

/// Queues the tets that were bisected among the crossings of a blade by others.
void queue_waiting(Cutter& cutter, Blade& blade);

/// The blade whose crossing cuts an edge, or none.
struct EdgeCut {
    const Blade* blade = nullptr;
    Crossing crossing = {};
};

/// Bisects an edge at (1 - t) u + t w and queues what changed. The tets around it, now in scratch.ring, keep
/// the side of u; those of w begin at the row that it returns. The sheet of the blade that cuts holds the new
/// vertex; every other blade keeps its crossing on the half that it lies on.
Index cut_edge(Cutter& cutter, const MaterialEdge& edge, double t, const EdgeCut& cut);

/// Gives a star of `vertex` its own vertex, with what every blade knows of the old one.
void detach_star(Cutter& cutter, Index vertex, std::span<const Index> star);

} // namespace resect
