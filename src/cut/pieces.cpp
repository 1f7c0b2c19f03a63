// SPDX-License-Identifier: Apache-2.0
#include "cut/pieces.hpp"

#include <algorithm>

namespace resect {
namespace {

struct Component {
    Index old_id = -1, first_copy = 0;
    double volume = 0;
    Index id = -1;
};

/// [copy] The row of its component: copies whose material is linked.
std::vector<Index> label_components(const Cutter& cutter, std::vector<Component>& components) {
    const std::size_t copies = cutter.mesh.copy_node.size();
    std::vector<Index> label(copies, -1);
    std::vector<Index> stack;
    for (std::size_t seed = 0; seed < copies; ++seed) {
        if (label[seed] >= 0) { continue; }
        const auto component = static_cast<Index>(components.size());
        components.push_back({cutter.pieces.of_copy[seed], static_cast<Index>(seed), 0, -1});
        label[seed] = component;
        stack.assign(1, static_cast<Index>(seed));
        while (!stack.empty()) {
            const Index copy = stack.back();
            stack.pop_back();
            for (Index m = cutter.first_tet[row(copy)]; m >= 0; m = cutter.material.tet(m).next) {
                components.back().volume += cutter.material.tet(m).volume;
                for (const Index link : cutter.material.tet(m).link) {
                    if (link < 0) { continue; }
                    const Index other = cutter.material.tet(tet_of(link)).copy;
                    if (label[row(other)] >= 0) { continue; }
                    label[row(other)] = component;
                    stack.push_back(other);
                }
            }
        }
    }
    return label;
}

/// The largest part of a piece keeps its id; others count on.
void assign_ids(std::vector<Component>& components, Index& next_id) {
    std::vector<Component*> order;
    order.reserve(components.size());
    for (Component& component : components) {
        order.push_back(&component);
    }
    std::sort(order.begin(), order.end(), [](const Component* a, const Component* b) {
        if (a->old_id != b->old_id) { return a->old_id < b->old_id; }
        return a->volume != b->volume ? a->volume > b->volume : a->first_copy < b->first_copy;
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Index old = order[i]->old_id;
        const bool keeps = old >= 0 && (i == 0 || order[i - 1]->old_id != old);
        order[i]->id = keeps ? old : next_id++;
    }
}

} // namespace

void relabel_pieces(Cutter& cutter) {
    PieceCache& cache = cutter.pieces;
    if (cache.revision == cutter.revision) { return; }
    cache.revision = cutter.revision;
    std::vector<Component> components;
    const std::vector<Index> label = label_components(cutter, components);
    assign_ids(components, cache.next_id);
    for (std::size_t c = 0; c < label.size(); ++c) {
        cache.of_copy.edit(c) = components[row(label[c])].id;
    }
    cache.pieces.clear();
    for (const Component& component : components) {
        Piece piece;
        piece.id = component.id;
        piece.volume = component.volume;
        cache.pieces.push_back(piece);
    }
    std::sort(cache.pieces.begin(), cache.pieces.end(),
              [](const Piece& a, const Piece& b) { return a.id < b.id; });
}

std::span<const Piece> update_pieces(Cutter& cutter, std::span<const Vec3f> displacement) {
    relabel_pieces(cutter);
    std::vector<Piece>& pieces = cutter.pieces.pieces;
    std::vector<Piece*> of_id(row(cutter.pieces.next_id), nullptr);
    for (Piece& piece : pieces) {
        piece.mass = 0;
        piece.centre = {};
        piece.held = false;
        of_id[row(piece.id)] = &piece;
    }
    const SimulationMesh& mesh = cutter.mesh;
    for (std::size_t c = 0; c < mesh.copy_node.size(); ++c) {
        Piece& piece = *of_id[row(cutter.pieces.of_copy[c])];
        piece.mass += mesh.copy_weight[c] * cutter.setup.element_mass[row(mesh.copy_element[c])];
        for (const Index node : mesh.copy_node[c]) {
            piece.held = piece.held || mesh.node_held[row(node)] != 0;
        }
        for (Index m = cutter.first_tet[c]; m >= 0; m = cutter.material.tet(m).next) {
            const MaterialTet& tet = cutter.material.tet(m);
            for (const Index v : tet.vertex) {
                piece.centre += (tet.volume / 4) * displaced_position(cutter, v, displacement);
            }
        }
    }
    for (Piece& piece : pieces) {
        piece.centre = (1 / piece.volume) * piece.centre;
    }
    return pieces;
}

Index count_pieces(Cutter& cutter) {
    relabel_pieces(cutter);
    return static_cast<Index>(cutter.pieces.pieces.size());
}

std::span<const Index> piece_of_copy(Cutter& cutter) {
    relabel_pieces(cutter);
    return cutter.pieces.of_copy;
}

} // namespace resect
