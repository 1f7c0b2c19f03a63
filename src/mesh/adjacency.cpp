// SPDX-License-Identifier: Apache-2.0
#include "mesh/adjacency.hpp"

#include <algorithm>
#include <tuple>

#include "base/assert.hpp"

namespace resect {
namespace {

struct FaceKey {
    Index middle, highest, slot;

    bool same_face(const FaceKey& other) const { return middle == other.middle && highest == other.highest; }
    bool operator<(const FaceKey& other) const {
        return std::tie(middle, highest, slot) < std::tie(other.middle, other.highest, other.slot);
    }
};

Triangle sorted_face(const TetMesh& mesh, Index slot) {
    Triangle nodes = face_nodes(mesh, slot);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

/// [node] where the faces whose lowest node it is begin; one more entry for the end.
std::vector<Index> count_by_lowest(const TetMesh& mesh, Index slot_count) {
    std::vector<Index> begin(mesh.nodes.size() + 1, 0);
    for (Index slot = 0; slot < slot_count; ++slot) {
        ++begin[row(sorted_face(mesh, slot)[0] + 1)];
    }
    for (std::size_t node = 1; node < begin.size(); ++node) {
        begin[node] += begin[node - 1];
    }
    return begin;
}

std::vector<FaceKey> scatter_by_lowest(const TetMesh& mesh, const std::vector<Index>& begin) {
    std::vector<FaceKey> keys(row(begin.back()));
    std::vector<Index> next = begin;
    for (Index slot = 0; slot < begin.back(); ++slot) {
        const Triangle nodes = sorted_face(mesh, slot);
        keys[row(next[row(nodes[0])]++)] = {nodes[1], nodes[2], slot};
    }
    return keys;
}

/// Adds the faces of one lowest node.
void append_groups(std::span<FaceKey> keys, FaceGroups& groups) {
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (i == 0 || !keys[i].same_face(keys[i - 1])) {
            groups.group.push_back(static_cast<Index>(groups.slots.size()));
        }
        groups.slots.push_back(keys[i].slot);
    }
}

void flood(std::span<const Index> mates, Index seed, Index component, Components& components) {
    std::vector<Index> open = {seed};
    components.of_tet[row(seed)] = component;
    while (!open.empty()) {
        const Index tet = open.back();
        open.pop_back();
        ++components.sizes[row(component)];
        for (Index slot = 4 * tet; slot < 4 * tet + 4; ++slot) {
            const Index mate = mates[row(slot)];
            if (mate == no_mate || components.of_tet[row(mate / 4)] >= 0) { continue; }
            components.of_tet[row(mate / 4)] = component;
            open.push_back(mate / 4);
        }
    }
}

} // namespace

FaceGroups build_face_groups(const TetMesh& mesh) {
    const Index slot_count = static_cast<Index>(4 * mesh.tets.size());
    const std::vector<Index> begin = count_by_lowest(mesh, slot_count);
    std::vector<FaceKey> keys = scatter_by_lowest(mesh, begin);
    FaceGroups groups;
    groups.slots.reserve(keys.size());
    groups.group.reserve(keys.size() / 2 + 1);
    for (std::size_t node = 0; node + 1 < begin.size(); ++node) {
        append_groups(std::span(keys).subspan(row(begin[node]), row(begin[node + 1] - begin[node])), groups);
    }
    groups.group.push_back(slot_count);
    return groups;
}

std::vector<Index> build_face_mates(const TetMesh& mesh) {
    const FaceGroups groups = build_face_groups(mesh);
    std::vector<Index> mates(groups.slots.size(), no_mate);
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const auto slots = groups[i];
        if (slots.size() < 2) { continue; }
        mates[row(slots[0])] = slots[1];
        mates[row(slots[1])] = slots[0];
    }
    return mates;
}

std::vector<Triangle> build_boundary(const TetMesh& mesh, std::span<const Index> mates) {
    RESECT_ASSERT(mates.size() == 4 * mesh.tets.size());
    std::vector<Triangle> triangles;
    for (std::size_t slot = 0; slot < mates.size(); ++slot) {
        if (mates[slot] == no_mate) { triangles.push_back(face_nodes(mesh, static_cast<Index>(slot))); }
    }
    return triangles;
}

Components build_components(std::span<const Index> mates) {
    Components components;
    components.of_tet.assign(mates.size() / 4, -1);
    for (std::size_t tet = 0; tet < components.of_tet.size(); ++tet) {
        if (components.of_tet[tet] >= 0) { continue; }
        components.sizes.push_back(0);
        flood(mates, static_cast<Index>(tet), static_cast<Index>(components.sizes.size() - 1), components);
    }
    return components;
}

} // namespace resect
