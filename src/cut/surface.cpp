// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "cut/cutter_state.hpp"

namespace resect {
namespace {

/// Vertices of one point have the same numbers here, and so the same position, bit for bit.
void place_vertices(SurfaceCache& surface, std::span<const Vec3f> displacement) {
    surface.position.resize(surface.vertex.size());
    for (std::size_t i = 0; i < surface.vertex.size(); ++i) {
        const SurfaceCache::Vertex& vertex = surface.vertex[i];
        Vec3f position = surface.rest[i];
        for (std::size_t k = 0; k < 4; ++k) {
            if (vertex.node[k] >= 0) { position += vertex.weight[k] * displacement[row(vertex.node[k])]; }
        }
        surface.position[i] = position;
    }
}

/// Means over the triangles of one label around a point, with the weights of Max (1999), sine of the angle
/// over the product of the two sides: exact on a sphere however unevenly it is triangulated. With weights by
/// area a wet surface mirrors every triangle of the lattice.
void compute_normals(SurfaceCache& surface) {
    constexpr float nothing = 1e-30F; // m^2: two points in one place
    surface.normal.assign(surface.vertex.size(), {});
    for (const auto& [a, b, c] : surface.triangle) {
        const Vec3f &p = surface.position[row(a)], &q = surface.position[row(b)],
                    &r = surface.position[row(c)];
        const Vec3f pq = q - p, qr = r - q, rp = p - r;
        const Vec3f twice_area = cross(pq, -1.0F * rp);
        const float from_pq = 1.0F / std::max(dot(pq, pq), nothing);
        const float from_qr = 1.0F / std::max(dot(qr, qr), nothing);
        const float from_rp = 1.0F / std::max(dot(rp, rp), nothing);
        surface.normal[row(a)] += (from_pq * from_rp) * twice_area;
        surface.normal[row(b)] += (from_pq * from_qr) * twice_area;
        surface.normal[row(c)] += (from_qr * from_rp) * twice_area;
    }
    for (Vec3f& normal : surface.normal) {
        normal = direction(normal);
    }
}

} // namespace

Surface update_surface(Cutter& cutter, std::span<const Vec3f> displacement, std::uint64_t since_revision) {
    SurfaceCache& surface = cutter.surface;
    Surface view;
    view.update_us = update_surface_topology(cutter);
    place_vertices(surface, displacement);
    compute_normals(surface);
    view.position = surface.position;
    view.normal = surface.normal;
    view.rest = surface.rest;
    view.point = surface.point;
    view.triangle = surface.triangle;
    view.face = surface.face;
    view.piece = surface.piece;
    view.dirty = surface.changed_triangles.since(since_revision, static_cast<Index>(view.triangle.size()));
    view.dirty_vertices =
        surface.changed_vertices.since(since_revision, static_cast<Index>(view.rest.size()));
    view.revision = surface.revision;
    return view;
}

std::vector<Index> copy_of_triangle(Cutter& cutter) {
    update_surface_topology(cutter);
    std::vector<Index> copies;
    copies.reserve(cutter.surface.link.size());
    for (const Index link : cutter.surface.link) {
        copies.push_back(cutter.material.tet(tet_of(link)).copy);
    }
    return copies;
}

} // namespace resect
