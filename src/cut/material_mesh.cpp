// SPDX-License-Identifier: Apache-2.0
#include "cut/material_mesh.hpp"

#include <algorithm>

#include "base/assert.hpp"

namespace resect {
namespace {

/// The row that the other half of a tet of the ring got.
Index half_of(std::span<const Index> ring, Index first, Index tet) {
    const auto at = std::find(ring.begin(), ring.end(), tet);
    RESECT_ASSERT(at != ring.end());
    return first + static_cast<Index>(at - ring.begin());
}

/// The corner that is neither on the edge nor `corner`.
std::size_t other_corner(const Tet& vertex, const MaterialEdge& edge, std::size_t corner) {
    std::size_t other = 0;
    while (other == corner || vertex[other] == edge.u || vertex[other] == edge.w) {
        ++other;
    }
    return other;
}

Index append_between(MaterialMesh& mesh, Index u, Index w, double t) {
    const Index z = mesh.vertex_count();
    mesh.rest.push_back((1 - t) * mesh.rest[row(u)] + t * mesh.rest[row(w)]);
    mesh.support.push_back(interpolate(mesh.support[row(u)], mesh.support[row(w)], t));
    mesh.any_tet.push_back(-1);
    mesh.grain.push_back((1 - t) * mesh.grain[row(u)] + t * mesh.grain[row(w)]);
    mesh.on_cut.push_back(0);
    return z;
}

} // namespace

void walk_star(const MaterialMesh& mesh, Index vertex, Index seed, Marks& marks, std::vector<Index>& star) {
    walk_star_until(mesh, vertex, seed, marks, star, [] { return false; });
}

bool find_ring(const MaterialMesh& mesh, const MaterialEdge& edge, Marks& marks, std::vector<Index>& ring) {
    ring.clear();
    Index at = edge.tet;
    std::size_t leave = 0; // the face to leave through
    while (mesh.tet(at).vertex[leave] == edge.u || mesh.tet(at).vertex[leave] == edge.w) {
        ++leave;
    }
    do {
        ring.push_back(at);
        const MaterialTet& tet = mesh.tet(at);
        const Index link = tet.link[leave];
        if (link < 0) { break; }
        const Index pivot = tet.vertex[other_corner(tet.vertex, edge, leave)];
        at = tet_of(link);
        leave = corner_of(mesh.tet(at).vertex, pivot);
    } while (at != edge.tet);
    const bool is_closed = ring.size() > 2 && at == edge.tet;
    if (is_closed) { return true; }
    ring.clear();
    marks.clear(mesh.tets.size());
    walk_star(mesh, edge.u, edge.tet, marks, ring);
    std::erase_if(ring, [&](Index tet) { return corner_of(mesh.tet(tet).vertex, edge.w) == 4; });
    return false;
}

Index bisect_edge(MaterialMesh& mesh, Index u, Index w, double t, std::span<const Index> ring) {
    const Index z = append_between(mesh, u, w, t);
    const Index first = mesh.tet_count();
    for (const Index m : ring) {
        const MaterialTet whole = mesh.tet(m);
        mesh.edit_tet(m).next = mesh.tet_count();
        mesh.tets.push_back(whole);
    }
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Index m = ring[i];
        const Index b = first + static_cast<Index>(i);
        MaterialTet& near = mesh.edit_tet(m);
        MaterialTet& far = mesh.edit_tet(b);
        const std::size_t iu = corner_of(near.vertex, u);
        const std::size_t iw = corner_of(near.vertex, w);
        near.vertex[iw] = z;
        far.vertex[iu] = z;
        near.volume = t * far.volume;
        far.volume -= near.volume;
        if (far.link[iu] >= 0) {
            mesh.edit_tet(tet_of(far.link[iu])).link[face_of(far.link[iu])] = make_link(b, iu);
        }
        near.link[iu] = make_link(b, iw);
        far.link[iw] = make_link(m, iu);
        near.element_face[iu] = far.element_face[iw] = -1;
        near.label[iu] = far.label[iw] = 0;
        mesh.any_tet.edit(row(w)) = b;
        for (std::size_t k = 0; k < 4; ++k) {
            if (k != iw) { mesh.any_tet.edit(row(near.vertex[k])) = m; }
            if (k == iu || k == iw || near.link[k] < 0) { continue; }
            far.link[k] = make_link(half_of(ring, first, tet_of(near.link[k])), face_of(near.link[k]));
        }
    }
    mesh.any_tet.edit(row(z)) = ring.front();
    return z;
}

Index split_vertex(MaterialMesh& mesh, Index vertex, std::span<const Index> star) {
    const Index twin = mesh.vertex_count();
    const std::size_t from = row(vertex);
    mesh.rest.push_back(mesh.rest[from]);
    mesh.support.push_back(mesh.support[from]);
    mesh.any_tet.push_back(star.front());
    mesh.grain.push_back(mesh.grain[from]);
    mesh.on_cut.push_back(mesh.on_cut[from]);
    for (const Index m : star) {
        Tet& corners = mesh.edit_tet(m).vertex;
        corners[corner_of(corners, vertex)] = twin;
    }
    return twin;
}

Vec3 face_normal(const MaterialMesh& mesh, Index tet, std::size_t face) {
    const MaterialTet& m = mesh.tet(tet);
    const auto& [a, b, c] = face_corners[face];
    const Vec3& origin = mesh.at(m, row(a));
    return cross(mesh.at(m, row(b)) - origin, mesh.at(m, row(c)) - origin);
}

} // namespace resect
