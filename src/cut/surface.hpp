// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.hpp"
#include "cut/marks.hpp"
#include "cut/range_history.hpp"

namespace resect {

struct Cutter;

/// The boundary of M as of `revision`. Rows of triangles and vertices stay where they are while what they
/// stand for does; a row that goes is filled by a new one or by the last.
struct SurfaceCache {
    std::uint64_t revision = 0; // 0: never built

    // Triangles: the boundary faces of M's tets.
    std::vector<std::array<Index, 3>> triangle = {};
    std::vector<Index> face = {}, piece = {};
    std::vector<Index> link = {};        // [triangle] the face of M's tet that it is
    std::vector<Index> triangle_of = {}; // [link] or -1
    RangeHistory changed_triangles = {};

    // Vertices: one for each material vertex and label of triangles around it.
    struct Vertex {
        Index label = 0;
        Index uses = 0;  // corners of triangles
        Index next = -1; // of the same material vertex; -1: last
        std::array<Index, 4> node = {-1, -1, -1, -1};
        std::array<float, 4> weight = {};
    };
    std::vector<Vertex> vertex = {};
    std::vector<Vec3f> rest = {}, position = {}, normal = {};
    std::vector<Index> point = {};        // [vertex] material vertex
    std::vector<Index> first_vertex = {}; // [material vertex] head of its list, or -1
    RangeHistory changed_vertices = {};

    // What increments changed since: tets whose faces or vertices may be others, copies with other nodes
    // or of another piece.
    RowSet stale_tets = {}, stale_copies = {};

    // What one update works with; kept only so that nothing is allocated again.
    std::vector<Index> added = {};                            // links
    std::vector<Index> removed = {};                          // triangles
    std::vector<Index> idle = {};                             // vertices that a triangle left
    std::vector<Index> new_triangles = {}, new_vertices = {}; // rows written
};

/// Notes what an increment changed, at the end of one that stands, before its rows are closed.
void note_surface_changes(Cutter& cutter);

/// Brings triangles and vertices up to date with M, at a cost of the order of what changed. Answers
/// microseconds, 0 where M was as before.
double update_surface_topology(Cutter& cutter);

} // namespace resect
