// SPDX-License-Identifier: Apache-2.0
#include "lab/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/index.hpp"
#include "base/vec.hpp"
#include "mesh/adjacency.hpp"

namespace lab {

using namespace resect;

namespace {

Triangle sorted(Triangle nodes) {
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

std::set<Triangle> list_boundary(const TetMesh& mesh) {
    std::set<Triangle> faces;
    for (const Triangle& face : build_boundary(mesh, build_face_mates(mesh))) {
        faces.insert(sorted(face));
    }
    return faces;
}

/// Barycentric weights of the point of a triangle's plane that is nearest to p, moved into the triangle.
Vec3 weigh(const std::array<Vec3, 3>& t, const Vec3& p) {
    const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
    const double area = dot(normal, normal);
    if (area == 0) { return {1, 0, 0}; }
    Vec3 weight = {dot(cross(t[2] - t[1], p - t[1]), normal) / area,
                   dot(cross(t[0] - t[2], p - t[2]), normal) / area, 0};
    weight[2] = 1 - weight[0] - weight[1];
    for (double& w : weight) {
        w = std::max(w, 0.0);
    }
    return (1 / (weight[0] + weight[1] + weight[2])) * weight;
}

Vec3 mix(const Vec3& weight, const std::array<Vec3, 3>& of) {
    return weight[0] * of[0] + weight[1] * of[1] + weight[2] * of[2];
}

/// Of the skin at the point of it that is nearest at rest.
Vec3 displacement_at(const CutSurface& surface, const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    Vec3 moved = {};
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (surface.is_cut[t] != 0) { continue; }
        std::array<Vec3, 3> rest = {};
        std::array<Vec3, 3> now = {};
        for (std::size_t k = 0; k < 3; ++k) {
            rest[k] = surface.rest[row(surface.triangles[t][k])];
            now[k] = surface.now[row(surface.triangles[t][k])];
        }
        const Vec3 weight = weigh(rest, p);
        const Vec3 at = mix(weight, rest);
        if (const double away = length(at - p); away < least) {
            least = away;
            moved = mix(weight, now) - at;
        }
    }
    return moved;
}

} // namespace

CutSurface surface_of(Simulation& simulation) {
    const Surface of = simulation.surface();
    CutSurface surface;
    for (std::size_t v = 0; v < of.position.size(); ++v) {
        surface.rest.push_back(to_double(of.rest[v]));
        surface.now.push_back(to_double(of.position[v]));
    }
    surface.triangles.assign(of.triangle.begin(), of.triangle.end());
    for (const Index face : of.face) {
        surface.is_cut.push_back(face == 0 ? 0 : 1);
    }
    return surface;
}

CutSurface surface_of(const CutMesh& cut, const TetMesh& before, const std::vector<Vec3>& displacement) {
    CutSurface surface{.rest = cut.mesh.nodes};
    for (std::size_t n = 0; n < displacement.size(); ++n) {
        surface.now.push_back(cut.mesh.nodes[n] + displacement[n]);
    }
    surface.triangles = build_boundary(cut.mesh, build_face_mates(cut.mesh));
    const std::set<Triangle> skin = list_boundary(before);
    for (const Triangle& face : surface.triangles) {
        const Triangle was = {cut.node_from[row(face[0])], cut.node_from[row(face[1])],
                              cut.node_from[row(face[2])]};
        surface.is_cut.push_back(skin.count(sorted(was)) > 0 ? 0 : 1);
    }
    return surface;
}

CutSurface surface_of(Simulation& simulation, const CutMesh& cut, const std::vector<Vec3>& displacement) {
    CutSurface surface = surface_of(simulation);
    std::map<Index, std::size_t> row_of; // by the material's node
    for (std::size_t n = 0; n < cut.node_from.size(); ++n) {
        row_of[cut.node_from[n]] = n;
    }
    const std::span<const Index> point = simulation.surface().point;
    for (std::size_t v = 0; v < surface.rest.size(); ++v) {
        surface.now[v] = surface.rest[v] + displacement[row_of.at(point[v])];
    }
    return surface;
}

Result<void> write_surface_file(const std::string& path, const CutSurface& surface) {
    // Skin and cut faces have vertices of their own, so that the lips are creases.
    const std::size_t count = surface.rest.size();
    std::vector<Vec3f> position(2 * count);
    std::vector<Vec3f> rest(2 * count);
    std::vector<Vec3> normal(2 * count);
    std::vector<Index> point(2 * count);
    for (std::size_t v = 0; v < 2 * count; ++v) {
        position[v] = to_float(surface.now[v % count]);
        rest[v] = to_float(surface.rest[v % count]);
        point[v] = static_cast<Index>(v % count);
    }
    std::vector<Triangle> triangles = surface.triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = surface.triangles[t];
        const Vec3 facet =
            cross(surface.now[row(b)] - surface.now[row(a)], surface.now[row(c)] - surface.now[row(a)]);
        for (Index& vertex : triangles[t]) {
            vertex += surface.is_cut[t] != 0 ? static_cast<Index>(count) : 0;
            normal[row(vertex)] += facet;
        }
    }
    std::vector<Vec3f> normals;
    normals.reserve(normal.size());
    for (const Vec3& n : normal) {
        normals.push_back(to_float(direction(n)));
    }
    const std::vector<Index> piece(triangles.size(), 0);
    return write_surface(path, {.position = position,
                                .normal = normals,
                                .rest = rest,
                                .point = point,
                                .triangle = triangles,
                                .face = surface.is_cut,
                                .piece = piece});
}

double measure_roughness(const CutSurface& surface, const Sheet& sheet) {
    double sum = 0;
    double area = 0;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (surface.is_cut[t] == 0) { continue; }
        const auto& [a, b, c] = surface.triangles[t];
        const Vec3 centroid =
            (1.0 / 3) * (surface.rest[row(a)] + surface.rest[row(b)] + surface.rest[row(c)]);
        const double facet = length(
            cross(surface.rest[row(b)] - surface.rest[row(a)], surface.rest[row(c)] - surface.rest[row(a)]));
        const double away = sheet.distance(centroid);
        sum += facet * away * away;
        area += facet;
    }
    return area > 0 ? std::sqrt(sum / area) : 0;
}

double measure_gauge(const CutSurface& surface, const Vec3& a, const Vec3& b) {
    const Vec3 apart = b - a;
    return length(apart + displacement_at(surface, b) - displacement_at(surface, a)) - length(apart);
}

} // namespace lab
