// SPDX-License-Identifier: Apache-2.0
#include "cut/cutter_state.hpp"

namespace resect {
namespace {

void collect_triangles(const Cutter& cutter, SurfaceCache& surface) {
    surface.triangle.clear();
    surface.face.clear();
    surface.copy.clear();
    for (const MaterialTet& tet : cutter.material.tets) {
        for (std::size_t k = 0; k < 4; ++k) {
            if (tet.link[k] >= 0) { continue; }
            const auto& [a, b, c] = face_corners[k];
            surface.triangle.push_back({tet.vertex[row(a)], tet.vertex[row(b)], tet.vertex[row(c)]});
            surface.face.push_back(tet.label[k]);
            surface.copy.push_back(tet.copy);
        }
    }
}

/// Vertices of the boundary only, by material vertex.
void number_vertices(const Cutter& cutter, SurfaceCache& surface) {
    std::vector<Index> number(cutter.material.rest.size(), -1);
    for (const auto& triangle : surface.triangle) {
        for (const Index v : triangle) {
            number[row(v)] = 0;
        }
    }
    surface.vertex.clear();
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] < 0) { continue; }
        number[v] = static_cast<Index>(surface.vertex.size());
        surface.vertex.push_back(static_cast<Index>(v));
    }
    for (auto& triangle : surface.triangle) {
        for (Index& v : triangle) {
            v = number[row(v)];
        }
    }
}

void hang_vertices(const Cutter& cutter, SurfaceCache& surface) {
    const std::size_t count = surface.vertex.size();
    surface.node.resize(count);
    surface.weight.resize(count);
    surface.rest.resize(count);
    surface.position.resize(count);
    surface.normal.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t v = row(surface.vertex[i]);
        const Support& support = cutter.material.support[v];
        const Index copy = cutter.material.tet(cutter.material.any_tet[v]).copy;
        surface.node[i] = find_nodes(cutter, support, copy);
        for (std::size_t k = 0; k < 4; ++k) {
            surface.weight[i][k] = static_cast<float>(support.weight[k]);
        }
        surface.rest[i] = to_float(cutter.material.rest[v]);
    }
}

void evaluate(SurfaceCache& surface, std::span<const Vec3f> displacement) {
    for (std::size_t i = 0; i < surface.vertex.size(); ++i) {
        Vec3f position = surface.rest[i];
        for (std::size_t k = 0; k < 4; ++k) {
            const Index node = surface.node[i][k];
            if (node >= 0) { position += surface.weight[i][k] * displacement[row(node)]; }
        }
        surface.position[i] = position;
        surface.normal[i] = {};
    }
    for (const auto& [a, b, c] : surface.triangle) {
        const Vec3f& origin = surface.position[row(a)];
        const Vec3f twice_area = cross(surface.position[row(b)] - origin, surface.position[row(c)] - origin);
        surface.normal[row(a)] += twice_area;
        surface.normal[row(b)] += twice_area;
        surface.normal[row(c)] += twice_area;
    }
    for (Vec3f& normal : surface.normal) {
        normal = direction(normal);
    }
}

} // namespace

Surface update_surface(Cutter& cutter, std::span<const Vec3f> displacement, std::uint64_t since_revision) {
    SurfaceCache& surface = cutter.surface;
    if (surface.revision != cutter.revision) {
        surface.revision = cutter.revision;
        collect_triangles(cutter, surface);
        number_vertices(cutter, surface);
        hang_vertices(cutter, surface);
        surface.piece.clear();
        for (const Index copy : surface.copy) {
            surface.piece.push_back(cutter.pieces.of_copy[row(copy)]);
        }
        surface.dirty = {0, static_cast<Index>(surface.triangle.size())};
    }
    evaluate(surface, displacement);
    Surface view;
    view.position = surface.position;
    view.normal = surface.normal;
    view.rest = surface.rest;
    view.triangle = surface.triangle;
    view.face = surface.face;
    view.piece = surface.piece;
    view.revision = surface.revision;
    if (since_revision < surface.revision) { view.dirty = {&surface.dirty, 1}; }
    return view;
}

} // namespace resect
