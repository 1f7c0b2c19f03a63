// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "cut/blade.hpp"
#include "cut/cutter.hpp"
#include "cut/marks.hpp"
#include "cut/material_mesh.hpp"
#include "cut/predicate.hpp"
#include "cut/surface.hpp"

namespace resect {

/// A material vertex, before and after an increment, in the frame of the blade.
struct Track {
    GridPoint before = {}, after = {};
    double height_before = 0, height_after = 0; // m above the tip
    std::uint8_t outside = 0;                   // a bit for each side of the blade's box that it stays beyond
    std::uint8_t half_planes = 0;               // a bit for each side of the axes across that it stays on
    bool on_grid = false;
};

/// A face of a tet.
struct TetFace {
    Index tet = 0;
    std::size_t face = 0;
};

/// What one increment works with; kept only so that nothing is allocated again.
struct Scratch {
    // detect
    std::vector<std::uint8_t> node_outside = {}; // [node] where classified
    Marks classified = {};                       // nodes
    std::vector<Index> near_copies = {};         // that may meet the blade
    std::vector<Index> copies_ahead = {};        // within BladeBox::ahead of it
    std::vector<Track> tracks = {};              // [vertex] where tracked
    Marks tracked = {};                          // vertices
    double least_path = 0;                       // m, of a tracked vertex past the blade
    std::vector<Index> near = {};                // vertices whose path meets the blade
    struct Event {
        MaterialEdge edge = {}; // u < w
        double t = 0;           // from u
        double height = 0;      // m above the tip
    };
    std::vector<Event> events = {};
    Index off_grid = 0; // tets left out because they are off the integer grid

    // bisect and tear
    std::span<const Vec3f> tissue = {}; // displacements as blades saw them last, [node]
    std::vector<Index> queue = {};      // tets to look at again
    Marks queued = {};                  // tets that have been in the queue
    std::vector<Index> dirty = {};      // the same as a list
    Index bisections = 0;
    bool is_runaway = false; // more bisections than an increment can want
    Marks walked = {};       // tets
    std::vector<Index> ring = {}, star = {};
    std::vector<TetFace> torn = {}; // both sides of each face, one after the other
    struct Seed {
        Index vertex = 0, tet = 0;
        bool operator<(const Seed& other) const {
            return vertex != other.vertex ? vertex < other.vertex : tet < other.tet;
        }
    };
    std::vector<Seed> seeds = {};
    Marks in_cluster = {}; // tets
    std::vector<Index> cluster = {};
    std::vector<Index> feet = {}; // vertices

    // derive
    std::vector<Index> parted = {}; // copies
    std::vector<Index> elements = {};
    /// A pair, 4 * copy + corner, whose class may have changed, and the node that it had.
    struct Touched {
        Index node = 0, pair = 0;
        bool operator==(const Touched&) const = default;
        bool operator<(const Touched& other) const {
            return node != other.node ? node < other.node : pair < other.pair;
        }
    };
    std::vector<Touched> touched = {};
    Marks walked_pairs = {};
    Marks reweighed = {}; // nodes whose mass or hold may change though they do not fall apart
    Marks noted = {};     // copies in Delta::touched_copies
    struct Part {
        std::size_t begin = 0, end = 0; // rows of part_tets
        double volume = 0;
    };
    std::vector<Index> part_tets = {};
    std::vector<Part> parts = {};
    Marks relisted = {}; // copies whose neighbours were found anew
    struct NodeClass {
        Index node = 0; // that its pairs had
        double mass = 0;
        std::size_t begin = 0, end = 0; // rows of pairs
    };
    std::vector<Index> pairs = {}; // 4 * copy + corner
    std::vector<NodeClass> classes = {};

    // pieces
    std::vector<Index> stack = {};
    Marks reached = {};                   // copies
    std::vector<Index> flood_of = {};     // [copy] where reached
    std::vector<Index> next_flooded = {}; // [copy] reached by the same flood after it, or -1
};

/// What all increments did so far.
struct Tally {
    std::int64_t crossings = 0, bisections = 0;
};

/// Components of the material. Masses and centres are those of the last look.
struct Pieces {
    Rows<Index> of_copy = {}; // ids; a new copy starts with its parent's
    Rows<Piece> pieces = {};  // [id]: a piece that falls apart is its largest part from then on
};

/// What cuts change, all of it: a snapshot is a copy.
struct CutterState {
    MaterialMesh material = {};
    SimulationMesh mesh = {};
    Rows<Index> first_tet = {};             // [copy] head of the list of its tets
    Rows<Index> sibling = {};               // [copy] next copy of the same element, or -1
    Rows<Index> first_copy = {};            // [element] head of that list
    Rows<Index> tet_count = {};             // [element] material tets
    Rows<std::array<Index, 4>> beside = {}; // [copy][face of the element], see beside.hpp

    std::vector<Blade> blades = {};
    Index strokes = 0;          // begun so far
    std::uint64_t revision = 1; // of the material's topology
    Pieces pieces = {};
};

/// Stages of an increment, for tests that make one fail.
enum class Stage { none, refine, detect, bisect, tear, derive };

struct Cutter : CutterState {
    Body body = {}; // R; its material is in `material`
    CutterSetup setup = {};
    std::vector<double> element_volume = {};      // [element] m^3
    std::vector<double> element_fill = {};        // [element] share that was material at creation
    std::vector<double> element_weight = {};      // [element] the solver's share of it, all copies together
    std::vector<std::uint8_t> held_faces = {};    // [element] a bit for each face that lies in a held region
    std::vector<std::uint8_t> held_elements = {}; // [element] 1: some of its nodes were held at creation
    double initial_volume = 0;                    // m^3, of the material at creation
    double mean_volume = 0;                       // m^3, of an element
    double unit = 1;                              // m, of the integer grid
    double grain = 0;                             // m, the largest of the material
    Index crowd = 0;             // material tets of an element from which ends of edges are pulled far
    Stage failing = Stage::none; // after which an increment is made to fail

    NearIndex near = {};
    SurfaceCache surface = {};
    Scratch scratch = {};
    Tally tally = {};

    Index element_of(Index tet) const { return mesh.copy_element[row(material.tet(tet).copy)]; }
    const Tet& element(Index copy) const { return body.elements.tets[row(mesh.copy_element[row(copy)])]; }
};

/// The copy's simulation nodes for a support over element nodes; -1 where the support has no more.
std::array<Index, 4> find_nodes(const Cutter& cutter, const Support& support, Index copy);

/// Where a simulation node is at rest, m.
inline const Vec3& rest_of_node(const Cutter& cutter, Index node) {
    return cutter.body.elements.nodes[row(cutter.mesh.node_reference[row(node)])];
}

/// Where a material vertex is now, m.
Vec3 displaced_position(const Cutter& cutter, Index vertex, std::span<const Vec3f> displacement);

} // namespace resect
