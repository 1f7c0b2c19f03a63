// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "resect/result.hpp"

namespace resect {

using Index = std::int32_t;
using Vec3 = std::array<double, 3>;
using Vec3f = std::array<float, 3>;

/// Closed, axis-aligned, in metres.
struct Box {
    Vec3 lo = {}, hi = {};
};

/// Four-node tetrahedra, positively oriented: node 3 lies on the side of face (0, 1, 2) that its
/// right-hand normal points to.
struct TetMesh {
    std::vector<Vec3> nodes = {};                // [node] m
    std::vector<std::array<Index, 4>> tets = {}; // [tet] rows of nodes
};

/// What is cut: elements carry the mechanics (R), material is what they hold (M).
struct Body {
    TetMesh elements = {};
    /// Conforming tets that tile the part of the elements that is filled. Vertex v < elements.nodes.size() is
    /// element node v (it may be unused). Empty: the material fills the elements.
    TetMesh material = {};
    std::vector<Index> element_of = {}; // [material tet] row of elements.tets
    std::vector<Index> region = {};     // [element] row of Setup::materials; empty: all 0
    std::map<std::string, std::vector<Index>> node_sets = {}; // rows of elements.nodes
    /// Spacing of the lattice that the elements come from, m; 0: a conforming mesh.
    double lattice_spacing = 0;
    /// What was mended while loading, one line each.
    std::vector<std::string> notes = {};
};

/// How fine a lattice body is: a number of elements, or the lattice spacing in metres; one of the two.
struct Lattice {
    Index elements = 0;
    double spacing = 0;
    int refine = 1; // levels by which the material is finer than the elements near the boundary, 0 to 3
};

/// How a block's cells are split into tets: six around the main diagonal (Kuhn), or a body-centred lattice.
enum class Split { six, bcc };

/// A block with its corner at the origin. Nodes run x fastest, then y, then z; six tets a cell (`six`).
Result<Body> make_block(Vec3 size, std::array<Index, 3> cells, Split split = Split::six);

/// A liver of 0.24 x 0.13 x 0.15 m, own implicit shape; x to the patient's left, y posterior, z cranial.
/// Lattice{.elements = N} gives N elements within 1 %, and exactly 6097 for 6097.
Result<Body> make_liver(Lattice lattice);

/// A body like a kidney, 0.12 m long, own implicit shape; z along its length, the hilum towards +x.
Result<Body> make_kidney(Lattice lattice);

/// The body where `inside_below_zero` is negative, which must lie in `bounds`; the function should be about a
/// distance in metres near the boundary.
Result<Body> make_body(const std::function<double(Vec3)>& inside_below_zero, Box bounds, Lattice lattice);

/// A tet mesh from a file, as it is: Gmsh .msh 2.2 and 4.1 (ASCII), VTK legacy .vtk and .vtu.
Result<Body> load_body(const std::string& path);

} // namespace resect
