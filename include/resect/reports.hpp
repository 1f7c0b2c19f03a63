// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "resect/body.hpp"

namespace resect {

/// Refused: what was asked for cannot be; nothing has been done.
enum class Status { ok, not_settled, diverged, refused };

/// Microseconds by stage of a cut: find crossings, bisect edges, tear faces, derive copies and nodes, check
/// what changed, have the precomputed quantities.
struct CutTimes {
    double detect = 0, bisect = 0, tear = 0, derive = 0, check = 0, quantities = 0;
    double total() const { return detect + bisect + tear + derive + check + quantities; }
};

/// Sums since the advance(), or the cut(), began.
struct CutReport {
    Index elements_cut = 0; // that have more than one copy now and had one before: none if torn along faces
    Index copies_added = 0, nodes_added = 0;
    Index pieces = 0;  // components of the material, now
    Index refused = 0; // increments in which a blade passed without cutting
    double area = 0;   // new sheet, one side, m^2
    std::string reason = {};
    Vec3 where = {}; // of the last refusal
    CutTimes us = {};
};

struct StepReport {
    Status status = Status::ok;
    std::int64_t steps = 0;
    Index element = -1;      // that diverged: row of Body::elements.tets
    std::string reason = {}; // empty while all is well
    CutReport cut = {};
};

/// A connected component of the material.
struct Piece {
    Index id = 0;      // kept while the piece exists, never reused
    double volume = 0; // m^3, at rest
    double mass = 0;   // kg, by the solver's weights
    Vec3 centre = {};  // of volume, now
    bool held = false; // some of it is held or prescribed
};

/// J. Elastic is that of the law without viscosity; gravity is zero at rest; damped is what both kinds of
/// damping, settling and changes of material have taken.
struct Energies {
    double kinetic = 0, elastic = 0, gravity = 0, damped = 0;
};

struct TimeStep {
    double used = 0;       // s
    double bound = 0;      // at rest: no cut lowers it
    double live_bound = 0; // of deformed copies, each looked at once in 5000 steps
};

/// The deformation that checks have met since the clock started: creation, or the end of settle().
struct Strain {
    double stretch_min = 1, stretch_max = 1;
    Index elements_beyond_range = 0; // most at any check: where the law is continued (docs/method.md)
    Index elements_inverted = 0;     // at the last check
    Index elements_weakened = 0;     // since creation: left the range, not borne by their neighbours
};

struct Range {
    Index begin = 0, end = 0;
};

/// The boundary of the material, closed and oriented outwards by its points. Edges may carry four triangles
/// where a crack pinches.
///
/// A point, a vertex of the material, has one vertex here for each value of `face` around it: normals are
/// means over the triangles around, smooth over the outer surface and over each side of a sheet, and break at
/// the lips. Vertices of one point have the same position, bit for bit, in any deformation.
///
/// `rest` is where the material was at the start, m, and so the coordinates of a solid texture on outer and
/// cut faces alike: the same on the two sides of a sheet, and changed by no deformation and no later cut.
///
/// A cut rewrites only what it changed. Triangles and vertices keep their rows while they last; rows that
/// fall free take new ones or the last.
struct Surface {
    std::span<const Vec3f> position = {}, normal = {}, rest = {}; // [vertex]
    std::span<const Index> point = {};                            // [vertex] row of material().material.nodes
    std::span<const std::array<Index, 3>> triangle = {};          // rows of position
    std::span<const Index> face = {};  // [triangle] 0 outer, +-k the sides of stroke k
    std::span<const Index> piece = {}; // [triangle] Piece::id
    // What changed since the revision asked for: few ranges, that may cover more. All of it where that
    // revision is more than 64 updates ago. The arrays may have grown or shrunk, too.
    std::span<const Range> dirty = {};          // of triangle, face, piece
    std::span<const Range> dirty_vertices = {}; // of rest, point
    std::uint64_t revision = 0;                 // of the topology
    double update_us = 0; // microseconds that this call spent on following cuts; 0: there were none
};

/// Simulation nodes, in an order of their own that suits the step; those that cuts add come last.
struct Nodes {
    std::span<const Vec3f> rest = {}, displacement = {}, velocity = {}; // m, m/s
    std::span<const float> mass = {};                                   // kg
    std::span<const std::uint8_t> fixed = {};                           // 1: held or prescribed
    std::span<const Index> reference = {};                              // row of Body::elements.nodes
};

/// Element copies.
struct Copies {
    std::span<const std::array<Index, 4>> node = {}; // rows of Nodes
    std::span<const Index> element = {};             // row of Body::elements.tets
    std::span<const Index> piece = {};               // Piece::id
    std::span<const double> fraction = {};           // of the element's volume that is this copy's material
};

} // namespace resect
