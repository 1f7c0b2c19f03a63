// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cut/cutter_state.hpp"

// The stages of an increment, in order. They hand on what they found in Cutter::scratch.
namespace resect {

struct Sweep {
    BladeFrame from = {}, to = {};
    std::span<const Vec3f> before = {}, after = {}; // displacements, [node]
};

/// Puts vertices that the blade passes closely on its sheet, records crossed edges, queues the tets around
/// both.
void detect_crossings(Cutter& cutter, Blade& blade, const Sweep& sweep, CutReport& report);

/// Bisects the crossed edges of every queued tet that they separate.
void bisect_separated(Cutter& cutter, Blade& blade);

/// Drops the links across the sheet, but not those that would leave crumbs, and splits vertices.
void tear_sheet(Cutter& cutter, Blade& blade, CutReport& report);

/// Links parts that tear_sheet tore off and that are too small to be meant, each through one face again.
void glue_crumbs(Cutter& cutter, CutReport& report);

/// Splits the vertices of torn faces whose star fell apart, into however many parts.
void part_torn_vertices(Cutter& cutter);

/// Copies, nodes and weights anew around torn faces.
void derive_simulation(Cutter& cutter, Delta& delta, CutReport& report);

/// Queues a tet, and notes it as changed.
void queue_tet(Cutter& cutter, Index tet);
void queue_ring(Cutter& cutter, Index u, Index w);

/// Gives a star of `vertex` its own vertex, with what every blade knows of the old one.
void detach_star(Cutter& cutter, Index vertex, std::span<const Index> star);

} // namespace resect
