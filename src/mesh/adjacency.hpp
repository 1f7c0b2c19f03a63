// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/index.hpp"
#include "mesh/tet.hpp"

// A face slot is 4 * tet + k: the face of the tet opposite corner k.
namespace resect {

using Triangle = std::array<Index, 3>;

inline constexpr Index no_mate = -1;

/// The three nodes of a face slot, outward for a positive tet.
inline Triangle face_nodes(const TetMesh& mesh, Index slot) {
    const Tet& tet = mesh.tets[row(slot / 4)];
    const int* corners = face_corners[slot % 4];
    return {tet[row(corners[0])], tet[row(corners[1])], tet[row(corners[2])]};
}

/// Face slots by their nodes: [group[i], group[i + 1]) of `slots` are one face, lowest slot first. Faces run
/// by their lowest, middle and highest node.
struct FaceGroups {
    std::vector<Index> slots = {};
    std::vector<Index> group = {};

    std::size_t size() const { return group.size() - 1; }
    std::span<const Index> operator[](std::size_t i) const {
        return std::span(slots).subspan(row(group[i]), row(group[i + 1] - group[i]));
    }
};
FaceGroups build_face_groups(const TetMesh& mesh);

/// [face slot] The slot of the same face in the tet beyond it, or no_mate on the boundary. A face of more
/// than two tets (mend_and_validate refuses it) mates its two lowest slots.
std::vector<Index> build_face_mates(const TetMesh& mesh);

/// The triangles of faces without a mate, outward, by face slot.
std::vector<Triangle> build_boundary(const TetMesh& mesh, std::span<const Index> mates);

/// Sets of tets that hang together by faces, numbered by their lowest tet.
struct Components {
    std::vector<Index> of_tet = {}; // [tet] its component
    std::vector<Index> sizes = {};  // [component] number of tets
};
Components build_components(std::span<const Index> mates);

} // namespace resect
