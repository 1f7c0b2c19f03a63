// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "base/vec.hpp"

namespace resect {

using Tet = std::array<Index, 4>;

/// Corners of the face opposite corner k, so ordered that the normal points out of a positive tet.
inline constexpr int face_corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/// Corners of a tet's six edges.
inline constexpr int edge_corners[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

inline double signed_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return dot(cross(b - a, c - a), d - a) / 6;
}

inline double signed_volume(const TetMesh& mesh, const Tet& tet) {
    const auto at = [&](int corner) -> const Vec3& {
        return mesh.nodes[static_cast<std::size_t>(tet[static_cast<std::size_t>(corner)])];
    };
    return signed_volume(at(0), at(1), at(2), at(3));
}

/// The box of the nodes that tets use.
inline Box bounds_of(const TetMesh& mesh) {
    const Vec3& first = mesh.nodes[static_cast<std::size_t>(mesh.tets.front()[0])];
    Box box = {first, first};
    for (const Tet& tet : mesh.tets) {
        for (const Index node : tet) {
            const Vec3& p = mesh.nodes[static_cast<std::size_t>(node)];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                box.lo[axis] = std::min(box.lo[axis], p[axis]);
                box.hi[axis] = std::max(box.hi[axis], p[axis]);
            }
        }
    }
    return box;
}

} // namespace resect
