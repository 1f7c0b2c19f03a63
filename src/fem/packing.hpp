// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "fem/elements.hpp"
#include "fem/kernels.hpp"
#include "fem/node_arrays.hpp"
#include "mesh/tet.hpp"

namespace resect {

/// The copies of a lane of FanTets; -1: none.
struct FanCopies {
    Index at[fan_lanes];
};

/// Copies of a part that lie together: fans do not reach from one cell into another, nor do blocks, but for
/// those of single tets.
struct Cell {
    std::vector<Index> copies = {};
    Index moved = 0;        // copies seated alone since it was packed
    Index moved_before = 0; // the same at its part's last turn in repack()
    Index quiet = 0;        // turns since another copy was moved
};

/// Copies that lie together and share a viscous time, in fans, with their own positions and forces of the
/// nodes that they hang on: slots [first_slot, first_slot + slots) of Packing.
struct Part {
    float viscous_time = 0;            // s
    Index first_slot = 0;              // row of Packing::position
    Index slots = 0, room = 0;         // rows used, and kept for it
    std::vector<FanBlock> blocks = {}; // first_tet ascending
    std::vector<FanNodes> nodes = {};
    std::vector<FanTets> tets = {};
    std::vector<FanCopies> copies = {}; // [row of tets]
    std::vector<Index> spare = {};      // rows of tets: blocks of single tets with free lanes
    std::vector<Cell> cells = {};
    std::vector<FanBlock> dropped = {}; // rows without a use
    std::vector<Index> left_range = {}; // copies that the forces computed last found beyond the trusted range
};

/// Where the step finds a copy.
struct Seat {
    Index part = -1, tet = 0, lane = 0; // row of Part::tets
    Index cell = 0;                     // row of Part::cells
};

/// What the step works on: copies as fans, nodes as slots, one a part that they hang in. Made from Elements
/// and patched by cuts, so it is part of the state: the order of its sums is the history of its cuts.
struct Packing {
    std::vector<Part> parts;
    std::vector<Seat> seats;           // [copy]
    float quanta_a_metre = 1;          // of positions
    std::vector<Place> rest, position; // [slot] position: x + viscous_time v
    std::vector<Row> force;            // [slot] N
    std::vector<Index> slot_node, slot_part;
    std::vector<Index> first_slot; // [node], -1: no copy hangs on it
    std::vector<Index> next_slot;  // [slot] of the same node in a later part; -1 ends
    bool one_viscous_time = true;
};

/// Nodes so that those that the same parts will hold follow one another, those of one part alone first: what
/// the step does to eight of them at a time, it then does without looking each up. `viscous_time` is by
/// element, s.
std::vector<Index> order_nodes(const TetMesh& elements, std::span<const float> viscous_time);

/// Packs all copies. The number of parts follows from the number of copies alone.
Packing build_packing(const Elements& elements, const NodeArrays& nodes);

/// Puts the slots of a node where displacement and velocity say.
void place_at(Packing& packing, Index node, const Vec3f& u, const Vec3f& v);
void place_node(Packing& packing, const NodeArrays& nodes, Index node);
void place_all_nodes(Packing& packing, const NodeArrays& nodes);

/// A copy that was appended, beside its parent.
void seat_new_copy(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index copy,
                   Index parent);
/// A copy that hangs on other nodes now.
void reseat_copy(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index copy);
/// A copy of which only the weight or the material changed.
void refresh_copy(Packing& packing, const Elements& elements, Index copy);

/// A turn of a part: packs the cell anew of which cuts have moved the most, if they have moved enough and,
/// where it is not very much, seem to be done with it.
void repack(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part);

/// The four slots of a seated copy, in the order of its fan.
std::array<Index, 4> slots_of(const Packing& packing, const Seat& seat);

std::size_t bytes_of(const Packing& packing); // about

/// The first broken invariant in words, or nothing. O(copies).
std::string find_packing_fault(const Packing& packing, const Elements& elements);

} // namespace resect
