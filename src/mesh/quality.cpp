// SPDX-License-Identifier: Apache-2.0
#include "mesh/quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/adjacency.hpp"

namespace resect {
namespace {

/// Below one by more than rounding.
constexpr double whole = 1 - 1e-9;

/// [corner] The face opposite it: outward normal, as long as twice the area.
std::array<Vec3, 4> face_normals(const TetMesh& mesh, const Tet& tet) {
    std::array<Vec3, 4> normals = {};
    for (std::size_t k = 0; k < 4; ++k) {
        const int* corners = face_corners[k];
        const Vec3& origin = mesh.nodes[row(tet[row(corners[0])])];
        normals[k] = cross(mesh.nodes[row(tet[row(corners[1])])] - origin,
                           mesh.nodes[row(tet[row(corners[2])])] - origin);
    }
    return normals;
}

double degrees_between(const Vec3& a, const Vec3& b) {
    return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

/// The angles between faces of a tet, into the least and the greatest.
void take_dihedrals(const std::array<Vec3, 4>& normals, MeshInfo& info) {
    for (const auto& corners : edge_corners) {
        const double angle = 180 - degrees_between(normals[row(corners[0])], normals[row(corners[1])]);
        info.dihedral_min = std::min(info.dihedral_min, angle);
        info.dihedral_max = std::max(info.dihedral_max, angle);
    }
}

/// Shapes of the elements.
void measure_elements(const TetMesh& mesh, MeshInfo& info) {
    info.volume_min = info.volume_max = signed_volume(mesh, mesh.tets.front());
    info.dihedral_min = 180;
    std::vector<double> altitudes; // [tet] the least of its four, 3 V / area
    altitudes.reserve(mesh.tets.size());
    for (const Tet& tet : mesh.tets) {
        const double volume = signed_volume(mesh, tet);
        info.volume_min = std::min(info.volume_min, volume);
        info.volume_max = std::max(info.volume_max, volume);
        const auto normals = face_normals(mesh, tet);
        take_dihedrals(normals, info);
        double longest = 0;
        for (const Vec3& normal : normals) {
            longest = std::max(longest, length(normal));
        }
        altitudes.push_back(6 * volume / longest);
    }
    info.altitude_min = *std::min_element(altitudes.begin(), altitudes.end());
    const auto middle = altitudes.begin() + static_cast<std::ptrdiff_t>(altitudes.size() / 2);
    std::nth_element(altitudes.begin(), middle, altitudes.end());
    info.altitude_median = *middle;
}

void measure_material(const TetMesh& material, MeshInfo& info) {
    for (const Tet& tet : material.tets) {
        info.volume += signed_volume(material, tet);
    }
    const auto mates = build_face_mates(material);
    info.components = static_cast<Index>(build_components(mates).sizes.size());
    info.boundary_triangles = static_cast<Index>(std::count(mates.begin(), mates.end(), no_mate));
}

void measure_fractions(const Body& body, MeshInfo& info) {
    for (const double fraction : compute_fractions(body)) {
        info.fraction_min = std::min(info.fraction_min, fraction);
        info.elements_partial += fraction < whole ? 1 : 0;
    }
}

} // namespace

std::vector<double> compute_fractions(const Body& body) {
    if (body.material.tets.empty()) { return std::vector<double>(body.elements.tets.size(), 1); }
    std::vector<double> fractions(body.elements.tets.size(), 0);
    for (std::size_t tet = 0; tet < body.material.tets.size(); ++tet) {
        fractions[row(body.element_of[tet])] += signed_volume(body.material, body.material.tets[tet]);
    }
    for (std::size_t element = 0; element < fractions.size(); ++element) {
        fractions[element] /= signed_volume(body.elements, body.elements.tets[element]);
    }
    return fractions;
}

MeshInfo measure_body(const Body& body) {
    MeshInfo info;
    info.nodes = static_cast<Index>(body.elements.nodes.size());
    info.tets = static_cast<Index>(body.elements.tets.size());
    if (body.elements.tets.empty()) { return info; }
    info.bounds = bounds_of(body.elements);
    measure_elements(body.elements, info);
    measure_material(body.material.tets.empty() ? body.elements : body.material, info);
    measure_fractions(body, info);
    return info;
}

} // namespace resect
