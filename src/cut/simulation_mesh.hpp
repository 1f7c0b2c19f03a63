// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.hpp"
#include "cut/rows.hpp"
#include "mesh/tet.hpp"

namespace resect {

/// S, the simulation mesh: element copies and their nodes, derived from the material's connectivity
/// (cutting.md C by way of docs/cutting.md). Written by cut/derive only; rows are appended, never moved.
struct SimulationMesh {
    // Element copies: the connected components of the material of one element.
    Rows<Tet> copy_node;        // [copy] rows of the node arrays
    Rows<Index> copy_element;   // [copy] row of Body::elements.tets
    Rows<double> copy_fraction; // [copy] share of the element's volume that is this copy's material
    Rows<double> copy_weight;   // [copy] the solver's share: floored, or the whole (Weights::copy)

    // Nodes: classes of (copy, corner) that are joined through material.
    Rows<Index> node_reference;   // [node] row of Body::elements.nodes
    Rows<double> node_mass;       // [node] kg, sum of weight * element mass / 4
    Rows<Vec3> node_home;         // [node] rest position of the material vertex nearest to the reference node
    Rows<std::uint8_t> node_held; // [node] 1: its home lies in a held region
};

/// What an update of S changed, for the owners of other arrays to follow. Rows in the order of their making.
struct Delta {
    struct NewCopy {
        Index parent = 0, copy = 0;
    };
    struct NewNode {
        Index source = 0, node = 0; // the new node starts with the source's motion
    };
    struct Corner {
        Index copy = 0, corner = 0, node = 0; // corner of an old or new copy that has another node now
    };
    std::vector<NewCopy> copies;
    std::vector<NewNode> nodes;
    std::vector<Corner> corners;
    std::vector<Index> weighed;        // copies, old and new, whose weight changed
    std::vector<Index> touched_nodes;  // old and new, whose mass, home or hold changed
    std::vector<Index> touched_copies; // weighed, or that hang on those, each once

    void clear() {
        copies.clear();
        nodes.clear();
        corners.clear();
        weighed.clear();
        touched_nodes.clear();
        touched_copies.clear();
    }
};

} // namespace resect
