// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <utility>

#include "base/clock.hpp"
#include "cut/cutter_state.hpp"

namespace resect {
namespace {

std::array<Index, 3> points_of(const MaterialTet& tet, std::size_t face) {
    const auto& [a, b, c] = face_corners[face];
    return {tet.vertex[row(a)], tet.vertex[row(b)], tet.vertex[row(c)]};
}

void bind_nodes(const Cutter& cutter, SurfaceCache::Vertex& vertex, Index point, Index copy) {
    vertex.node = find_nodes(cutter, cutter.material.support[row(point)], copy);
}

Index append_vertex(Cutter& cutter, Index point, Index label) {
    SurfaceCache& surface = cutter.surface;
    const MaterialMesh& material = cutter.material;
    const auto at = static_cast<Index>(surface.vertex.size());
    SurfaceCache::Vertex vertex;
    vertex.label = label;
    vertex.next = std::exchange(surface.first_vertex[row(point)], at);
    bind_nodes(cutter, vertex, point, material.tet(material.any_tet[row(point)]).copy);
    for (std::size_t k = 0; k < 4; ++k) {
        vertex.weight[k] = static_cast<float>(material.support[row(point)].weight[k]);
    }
    surface.vertex.push_back(vertex);
    surface.rest.push_back(to_float(material.rest[row(point)]));
    surface.point.push_back(point);
    surface.new_vertices.push_back(at);
    return at;
}

/// A corner of a triangle more for the vertex of a point and label.
Index take_vertex(Cutter& cutter, Index point, Index label) {
    SurfaceCache& surface = cutter.surface;
    Index at = surface.first_vertex[row(point)];
    while (at >= 0 && surface.vertex[row(at)].label != label) {
        at = surface.vertex[row(at)].next;
    }
    if (at < 0) { at = append_vertex(cutter, point, label); }
    ++surface.vertex[row(at)].uses;
    return at;
}

void leave_vertices(SurfaceCache& surface, const std::array<Index, 3>& corners) {
    for (const Index at : corners) {
        if (at >= 0 && --surface.vertex[row(at)].uses == 0) { surface.idle.push_back(at); }
    }
}

/// Makes a row of triangles show a face of M; a row that is new has corners -1.
void write_triangle(Cutter& cutter, Index triangle, Index link) {
    SurfaceCache& surface = cutter.surface;
    const MaterialTet& tet = cutter.material.tet(tet_of(link));
    const Index label = tet.label[face_of(link)];
    std::array<Index, 3> corners = points_of(tet, face_of(link));
    for (Index& corner : corners) {
        corner = take_vertex(cutter, corner, label);
    }
    leave_vertices(surface, std::exchange(surface.triangle[row(triangle)], corners));
    surface.face[row(triangle)] = label;
    surface.piece[row(triangle)] = cutter.pieces.of_copy[row(tet.copy)];
    surface.link[row(triangle)] = link;
    surface.triangle_of[row(link)] = triangle;
    surface.new_triangles.push_back(triangle);
}

bool shows(const SurfaceCache& surface, Index triangle, const MaterialTet& tet, std::size_t face) {
    const std::array<Index, 3> points = points_of(tet, face);
    for (std::size_t k = 0; k < 3; ++k) {
        if (surface.point[row(surface.triangle[row(triangle)][k])] != points[k]) { return false; }
    }
    return surface.face[row(triangle)] == tet.label[face];
}

/// Rewrites the triangles of a tet that are others now, and collects those that came and went.
void update_tet(Cutter& cutter, Index tet) {
    SurfaceCache& surface = cutter.surface;
    const MaterialTet& now = cutter.material.tet(tet);
    for (std::size_t face = 0; face < 4; ++face) {
        const Index link = make_link(tet, face);
        const Index triangle = surface.triangle_of[row(link)];
        const bool is_boundary = now.link[face] < 0;
        if (triangle < 0) {
            if (is_boundary) { surface.added.push_back(link); }
        } else if (!is_boundary) {
            surface.triangle_of[row(link)] = -1;
            surface.removed.push_back(triangle);
        } else if (!shows(surface, triangle, now, face)) {
            write_triangle(cutter, triangle, link);
        }
    }
}

/// New triangles take the rows of those that went, and then rows of their own.
void place_added(Cutter& cutter) {
    SurfaceCache& surface = cutter.surface;
    for (const Index link : surface.added) {
        auto triangle = static_cast<Index>(surface.triangle.size());
        if (!surface.removed.empty()) {
            triangle = surface.removed.back();
            surface.removed.pop_back();
        } else {
            surface.triangle.push_back({-1, -1, -1});
            surface.face.push_back(0);
            surface.piece.push_back(-1);
            surface.link.push_back(-1);
        }
        write_triangle(cutter, triangle, link);
    }
}

/// The rows that are left over are filled from the end, the highest first: so the last row is never one of
/// them.
void fill_removed(SurfaceCache& surface) {
    std::sort(surface.removed.begin(), surface.removed.end(), std::greater<>());
    for (const Index at : surface.removed) {
        leave_vertices(surface, surface.triangle[row(at)]);
        if (row(at) + 1 < surface.triangle.size()) {
            surface.triangle[row(at)] = surface.triangle.back();
            surface.face[row(at)] = surface.face.back();
            surface.piece[row(at)] = surface.piece.back();
            surface.link[row(at)] = surface.link.back();
            surface.triangle_of[row(surface.link[row(at)])] = at;
            surface.new_triangles.push_back(at);
        }
        surface.triangle.pop_back();
        surface.face.pop_back();
        surface.piece.pop_back();
        surface.link.pop_back();
    }
}

/// In the list of its point.
void replace_in_list(SurfaceCache& surface, Index vertex, Index by) {
    Index* at = &surface.first_vertex[row(surface.point[row(vertex)])];
    while (*at != vertex) {
        at = &surface.vertex[row(*at)].next;
    }
    *at = by;
}

/// In the triangles around its point, which are faces of the tets of the point's star.
void replace_in_triangles(Cutter& cutter, Index vertex, Index by) {
    SurfaceCache& surface = cutter.surface;
    Scratch& scratch = cutter.scratch;
    const Index point = surface.point[row(vertex)];
    scratch.walked.clear(cutter.material.tets.size());
    scratch.star.clear();
    walk_star(cutter.material, point, cutter.material.any_tet[row(point)], scratch.walked, scratch.star);
    for (const Index tet : scratch.star) {
        for (std::size_t face = 0; face < 4; ++face) {
            const Index triangle = surface.triangle_of[row(make_link(tet, face))];
            if (triangle < 0) { continue; }
            for (Index& corner : surface.triangle[row(triangle)]) {
                if (corner != vertex) { continue; }
                corner = by;
                surface.new_triangles.push_back(triangle);
            }
        }
    }
}

/// Rows of vertices that no triangle has any more are filled from the end, the highest first.
void fill_idle(Cutter& cutter) {
    SurfaceCache& surface = cutter.surface;
    std::sort(surface.idle.begin(), surface.idle.end(), std::greater<>());
    surface.idle.erase(std::unique(surface.idle.begin(), surface.idle.end()), surface.idle.end());
    for (const Index at : surface.idle) {
        if (surface.vertex[row(at)].uses > 0) { continue; }
        replace_in_list(surface, at, surface.vertex[row(at)].next);
        const auto last = static_cast<Index>(surface.vertex.size()) - 1;
        if (at != last) {
            replace_in_list(surface, last, at);
            replace_in_triangles(cutter, last, at);
            surface.vertex[row(at)] = surface.vertex.back();
            surface.rest[row(at)] = surface.rest.back();
            surface.point[row(at)] = surface.point.back();
            surface.new_vertices.push_back(at);
        }
        surface.vertex.pop_back();
        surface.rest.pop_back();
        surface.point.pop_back();
    }
}

void rebind_copy(Cutter& cutter, Index copy) {
    SurfaceCache& surface = cutter.surface;
    for (Index m = cutter.first_tet[row(copy)]; m >= 0; m = cutter.material.tet(m).next) {
        for (const Index point : cutter.material.tet(m).vertex) {
            Index at = surface.first_vertex[row(point)];
            for (; at >= 0; at = surface.vertex[row(at)].next) {
                bind_nodes(cutter, surface.vertex[row(at)], point, copy);
            }
        }
    }
}

/// Of the triangles of a copy.
void update_piece(Cutter& cutter, Index copy) {
    SurfaceCache& surface = cutter.surface;
    const Index piece = cutter.pieces.of_copy[row(copy)];
    for (Index m = cutter.first_tet[row(copy)]; m >= 0; m = cutter.material.tet(m).next) {
        for (std::size_t face = 0; face < 4; ++face) {
            const Index triangle = surface.triangle_of[row(make_link(m, face))];
            if (triangle < 0 || surface.piece[row(triangle)] == piece) { continue; }
            surface.piece[row(triangle)] = piece;
            surface.new_triangles.push_back(triangle);
        }
    }
}

void update_stale(Cutter& cutter) {
    SurfaceCache& surface = cutter.surface;
    surface.triangle_of.resize(4 * cutter.material.tets.size(), -1);
    surface.first_vertex.resize(cutter.material.rest.size(), -1);
    surface.added.clear();
    surface.removed.clear();
    surface.idle.clear();
    surface.new_triangles.clear();
    surface.new_vertices.clear();
    if (surface.revision == 0) {
        for (Index tet = 0; tet < cutter.material.tet_count(); ++tet) {
            update_tet(cutter, tet);
        }
    } else {
        for (const Index tet : surface.stale_tets.rows()) {
            update_tet(cutter, tet);
        }
        for (const Index copy : surface.stale_copies.rows()) {
            rebind_copy(cutter, copy);
        }
    }
    place_added(cutter);
    fill_removed(surface);
    fill_idle(cutter);
    for (const Index copy : surface.stale_copies.rows()) {
        update_piece(cutter, copy);
    }
    surface.stale_tets.clear();
    surface.stale_copies.clear();
}

} // namespace

void note_surface_changes(Cutter& cutter) {
    SurfaceCache& surface = cutter.surface;
    const auto note_copy = [&](std::size_t at) { surface.stale_copies.add(static_cast<Index>(at)); };
    cutter.material.tets.each_changed(
        [&](std::size_t at) { surface.stale_tets.add(static_cast<Index>(at)); });
    cutter.mesh.copy_node.each_changed(note_copy);
    cutter.pieces.of_copy.each_changed(note_copy);
}

double update_surface_topology(Cutter& cutter) {
    SurfaceCache& surface = cutter.surface;
    if (surface.revision == cutter.revision) { return 0; }
    Stopwatch watch;
    update_stale(cutter);
    if (surface.revision == 0) {
        surface.changed_triangles.restart(cutter.revision);
        surface.changed_vertices.restart(cutter.revision);
    } else {
        surface.changed_triangles.add(cutter.revision, surface.new_triangles);
        surface.changed_vertices.add(cutter.revision, surface.new_vertices);
    }
    surface.revision = cutter.revision;
    return watch.lap();
}

} // namespace resect
