// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "resect/body.hpp"

namespace resect::fuzz {

/// How a body is made, in full: a block of Kuhn cubes whose inner nodes are moved about, or the liver's
/// lattice.
struct BodySpec {
    bool is_liver = false;
    // Of a block.
    Vec3 size = {1, 1, 1}; // m
    std::array<Index, 3> cells = {4, 4, 4};
    double jitter = 0;       // shares of a cell by which a node is moved at most, in each pass
    int passes = 1;          // over all nodes
    double least_volume = 0; // of a tet after a move, in means; a move that leaves less is not made
    std::uint64_t seed = 0;  // of the moves
    // Of a liver.
    double spacing = 0; // m
    Vec3 offset = {};   // shares of the spacing
    int refine = 0;
};

/// A block of unit edge with well-shaped tets.
BodySpec jittered_block(Index cells, std::uint64_t seed);
/// The same with slivers: tets of positive volume that may be as flat as a fiftieth of a good one.
BodySpec crumpled_block(Index cells, std::uint64_t seed);

Body make_body(const BodySpec& spec);

/// The edge of a cube of six mean tets, m.
double mean_edge(const Body& body);

} // namespace resect::fuzz
