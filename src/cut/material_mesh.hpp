// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cut/rows.hpp"
#include "cut/support.hpp"

namespace resect {

/// A face of a tet as one number, for links.
constexpr Index make_link(Index tet, std::size_t face) { return 4 * tet + static_cast<Index>(face); }
constexpr Index tet_of(Index link) { return link / 4; }
constexpr std::size_t face_of(Index link) { return row(link % 4); }

struct MaterialTet {
    Tet vertex = {};
    std::array<Index, 4> link = {-1, -1, -1, -1}; // [face] the same face as another tet has it; -1: boundary
    std::array<Index, 4> label = {};              // [boundary face] 0 outer, +-k the sides of stroke k
    std::array<std::int8_t, 4> element_face = {-1, -1, -1,
                                               -1}; // [face] the element's face that holds it, or -1
    Index copy = 0;
    Index next = -1;   // of the copy's tets; -1: last
    double volume = 0; // m^3
};

/// M, the material: conforming tets that tile the filled part of the elements. Changed in two ways only, both
/// legal anywhere: an edge is bisected, a vertex is split between parts of its star (and links are dropped).
struct MaterialMesh {
    Rows<MaterialTet> tets = {};
    Rows<Vec3> rest = {};           // [vertex] m
    Rows<Support> support = {};     // [vertex] over element nodes
    Rows<Index> any_tet = {};       // [vertex] one tet of its star; -1: unused
    Rows<double> grain = {};        // [vertex] m, edge of the tets here at creation
    Rows<std::uint8_t> on_cut = {}; // [vertex] 1: on a sheet that was torn

    MaterialTet& edit_tet(Index at) { return tets.edit(row(at)); }
    const MaterialTet& tet(Index at) const { return tets[row(at)]; }
    Index tet_count() const { return static_cast<Index>(tets.size()); }
    Index vertex_count() const { return static_cast<Index>(rest.size()); }
    const Vec3& at(const MaterialTet& tet, std::size_t corner) const { return rest[row(tet.vertex[corner])]; }
};

/// The tets around `vertex` that links join to `seed`, through faces that contain the vertex, until
/// `is_enough`. Appended to `star` and marked; marks that are there already are walls.
template <class IsEnough>
void walk_star_until(const MaterialMesh& mesh, Index vertex, Index seed, Marks& marks,
                     std::vector<Index>& star, IsEnough is_enough) {
    std::size_t next = star.size();
    marks.set(seed);
    star.push_back(seed);
    for (; next < star.size() && !is_enough(); ++next) {
        const MaterialTet& tet = mesh.tet(star[next]);
        for (std::size_t k = 0; k < 4; ++k) {
            if (tet.vertex[k] == vertex || tet.link[k] < 0) { continue; }
            const Index other = tet_of(tet.link[k]);
            if (marks.set(other)) { star.push_back(other); }
        }
    }
}

/// All of them.
void walk_star(const MaterialMesh& mesh, Index vertex, Index seed, Marks& marks, std::vector<Index>& star);

/// An edge, and a tet around it.
struct MaterialEdge {
    Index u = 0, w = 0, tet = 0;
};

/// The tets around an edge. True if they close around it; else cracks may part them into several fans, and
/// all of them are found.
bool find_ring(const MaterialMesh& mesh, const MaterialEdge& edge, Marks& marks, std::vector<Index>& ring);

/// Halves the tets of `ring` at (1 - t) u + t w and returns the new vertex. A halved tet keeps the side of u;
/// the sides of w are appended in the ring's order.
Index bisect_edge(MaterialMesh& mesh, Index u, Index w, double t, std::span<const Index> ring);

/// Gives the tets of `star` a vertex of their own in place of `vertex`, and returns it.
Index split_vertex(MaterialMesh& mesh, Index vertex, std::span<const Index> star);

/// Vector of twice the area of a face of a tet at rest, out of the tet.
Vec3 face_normal(const MaterialMesh& mesh, Index tet, std::size_t face);

} // namespace resect
