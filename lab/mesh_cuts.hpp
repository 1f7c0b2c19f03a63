// SPDX-License-Identifier: Apache-2.0
// How others cut a tet mesh: each takes the mesh and the sheet, and gives a mesh that is simulated as any.
#pragma once

#include "lab/sheet.hpp"

namespace lab {

/// A mesh that a cut has made, and where its nodes come from.
struct CutMesh {
    TetMesh mesh = {};
    std::vector<Index> node_from = {}; // [node] row of the mesh that was cut
};

/// Element removal (Cotin et al. 2000; SOFA's carving): deletes the tets with an edge that the sheet crosses.
CutMesh remove_elements(const TetMesh& mesh, const Sheet& sheet);
/// Rows of the tets that remove_elements() deletes.
std::vector<Index> find_crossed(const TetMesh& mesh, const Sheet& sheet);

/// Splitting along element faces (Nienhuys and van der Stappen 2001): opens the faces that the sheet passes
/// between the centroids of, and doubles the nodes whose tets then no longer hang together by faces.
CutMesh split_faces(const TetMesh& mesh, const Sheet& sheet);

/// Moves nodes nearer to the sheet than `reach` onto it, unless that would leave a tet with less than a tenth
/// of its volume (node snapping; Nienhuys and van der Stappen 2001). Nodes of the boundary slide within
/// its faces only if the boundary is that of `block`.
TetMesh snap_nodes(TetMesh mesh, const Sheet& sheet, double reach, const Box& block);

/// Without the nodes that no tet uses.
CutMesh drop_unused_nodes(const TetMesh& mesh);

/// A block of Kuhn cells whose inner nodes are moved about by up to `share` of a cell, and those on its faces
/// within them. Layers across x are bent before by half a cell, so that a flat sheet across x goes through
/// cells at every height; not if nothing is to be moved.
TetMesh make_jittered_block(const Vec3& size, const std::array<Index, 3>& cells, double share, unsigned seed);

double volume_of(const TetMesh& mesh);

} // namespace lab
