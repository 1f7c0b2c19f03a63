// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "base/index.hpp"
#include "mesh/tet.hpp"

namespace resect {

/// Cells of six tets around the main diagonal; nodes x fastest.
inline TetMesh kuhn_block(const Vec3& size, const std::array<Index, 3>& cells) {
    TetMesh mesh;
    const auto node = [&](const std::array<Index, 3>& at) {
        return at[0] + (cells[0] + 1) * (at[1] + (cells[1] + 1) * at[2]);
    };
    for (Index z = 0; z <= cells[2]; ++z) {
        for (Index y = 0; y <= cells[1]; ++y) {
            for (Index x = 0; x <= cells[0]; ++x) {
                mesh.nodes.push_back(
                    {size[0] * x / cells[0], size[1] * y / cells[1], size[2] * z / cells[2]});
            }
        }
    }
    const auto add_cell = [&](const std::array<Index, 3>& cell) {
        std::array<std::size_t, 3> axes = {0, 1, 2};
        do { // from the cell's corner to the opposite one along the axes in every order
            Tet tet = {node(cell)};
            std::array<Index, 3> at = cell;
            for (std::size_t k = 0; k < 3; ++k) {
                ++at[axes[k]];
                tet[k + 1] = node(at);
            }
            if (signed_volume(mesh, tet) < 0) { std::swap(tet[2], tet[3]); }
            mesh.tets.push_back(tet);
        } while (std::next_permutation(axes.begin(), axes.end()));
    };
    for (Index z = 0; z < cells[2]; ++z) {
        for (Index y = 0; y < cells[1]; ++y) {
            for (Index x = 0; x < cells[0]; ++x) {
                add_cell({x, y, z});
            }
        }
    }
    return mesh;
}

} // namespace resect
