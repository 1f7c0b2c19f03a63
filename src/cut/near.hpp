// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/index.hpp"
#include "cut/marks.hpp"
#include "mesh/tet.hpp"

namespace resect {

struct Cutter;

inline constexpr std::size_t nodes_in_group = 32;
inline constexpr std::size_t elements_in_block = 32;

/// Nodes of S that lie together, and where they rest, m. Places beyond `count` repeat the first, so that all
/// are worked on alike.
struct NodeGroup {
    std::array<Index, nodes_in_group> node = {};
    std::array<float, nodes_in_group> x = {}, y = {}, z = {};
    std::size_t count = 0;
};

/// Elements that lie together: their copies, and the groups of the nodes that those hang on.
struct NearBlock {
    struct Copy {
        Index copy = 0;
        Tet node = {};
    };
    std::vector<Copy> copies = {};
    std::vector<Index> groups = {};
};

/// Nodes and elements of S by place, to look up what a blade may meet (near.cpp). It follows S, and is no
/// part of the state.
struct NearIndex {
    std::vector<Index> order = {};            // elements, neighbours close together
    std::vector<Index> place_of_element = {}; // where in `order`
    double scale = 0;                         // m, the largest coordinate of the body at rest
    std::vector<NodeGroup> groups = {};       // empty: to be found
    std::vector<Index> group_of_node = {};
    Marks listed = {};                  // groups of the block at work
    std::vector<NearBlock> blocks = {}; // [place in order / elements_in_block]
    std::vector<Index> changed = {};    // copies that are new, or hang on other nodes than `blocks` knows of
};

/// How long what lies in S is too far from a blade to be cut. No part of the state: it can be found anew at
/// any time.
struct Approach {
    double moved = 0; // m, bound on the motion of blade and tissue towards each other so far
    std::vector<double> safe_until = {};   // [group] value of `moved` up to which `beyond` holds
    std::vector<std::uint8_t> beyond = {}; // [group] sides of the blade's box that all its nodes lie beyond
    std::vector<std::uint8_t> node_beyond = {}; // [node] the same of each, or less
    std::vector<double> block_safe_until =
        {}; // [block] value of `moved` up to which it need not be looked at
};

/// Puts elements and nodes in an order that keeps neighbours close together.
void index_by_place(Cutter& cutter);
/// S is another: its nodes are to be grouped anew.
void forget_places(Cutter& cutter);
/// Takes in the nodes and copies that cuts have made since, and the copies that they hung on other nodes.
void follow_cuts(Cutter& cutter);
/// A copy is new, or hangs on a node that it did not hang on before.
void note_changed_copy(Cutter& cutter, Index copy);

} // namespace resect
