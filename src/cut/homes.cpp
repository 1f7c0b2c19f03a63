// SPDX-License-Identifier: Apache-2.0
#include "cut/homes.hpp"

#include <algorithm>
#include <limits>

namespace resect {
namespace {

bool holds(const HeldRegion& region, const Vec3& rest, const Support& support) {
    if (region.node_marked.empty()) { return is_inside(region.box, rest); }
    for (const Index node : support.node) {
        if (node >= 0 && region.node_marked[row(node)] == 0) { return false; }
    }
    return true;
}

bool holds_face(const Cutter& cutter, const HeldRegion& region, const Tet& element, std::size_t face) {
    for (std::size_t k = 0; k < 4; ++k) {
        if (k == face) { continue; }
        const Support node = {{element[k], -1, -1, -1}, {1, 0, 0, 0}};
        if (!holds(region, cutter.body.elements.nodes[row(element[k])], node)) { return false; }
    }
    return true;
}

/// The copy has skin on a held face of its element that contains the corner.
bool has_held_skin(const Cutter& cutter, Index copy, std::size_t corner) {
    const unsigned held = cutter.held_faces[row(cutter.mesh.copy_element[row(copy)])] & ~(1U << corner);
    if (held == 0) { return false; }
    for (Index m = cutter.first_tet[row(copy)]; m >= 0; m = cutter.material.tet(m).next) {
        const MaterialTet& tet = cutter.material.tet(m);
        for (std::size_t k = 0; k < 4; ++k) {
            const bool is_skin = tet.link[k] < 0 && tet.label[k] == 0 && tet.element_face[k] >= 0;
            if (is_skin && ((held >> unsigned(tet.element_face[k])) & 1U) != 0) { return true; }
        }
    }
    return false;
}

/// Where its home is held, or some of its skin: cuts may leave the home off a wall that the material still
/// has.
bool is_held(const Cutter& cutter, std::span<const Index> pairs, Index home) {
    const MaterialMesh& material = cutter.material;
    const std::vector<HeldRegion>& held = cutter.setup.held;
    return std::any_of(held.begin(), held.end(),
                       [&](const HeldRegion& region) {
                           return holds(region, material.rest[row(home)], material.support[row(home)]);
                       }) ||
           std::any_of(pairs.begin(), pairs.end(),
                       [&](Index pair) { return has_held_skin(cutter, pair / 4, face_of(pair)); });
}

} // namespace

void mark_held_faces(Cutter& cutter) {
    for (const Tet& element : cutter.body.elements.tets) {
        unsigned faces = 0;
        for (const HeldRegion& region : cutter.setup.held) {
            for (unsigned face = 0; face < 4; ++face) {
                faces |= unsigned{holds_face(cutter, region, element, face)} << face;
            }
        }
        cutter.held_faces.push_back(static_cast<std::uint8_t>(faces));
    }
}

Index find_home(const Cutter& cutter, std::span<const Index> pairs, Index reference) {
    const Vec3& goal = cutter.body.elements.nodes[row(reference)];
    double nearest = std::numeric_limits<double>::infinity();
    Index home = -1;
    for (const Index pair : pairs) {
        for (Index m = cutter.first_tet[row(pair / 4)]; m >= 0; m = cutter.material.tet(m).next) {
            for (const Index v : cutter.material.tet(m).vertex) {
                const Vec3 r = cutter.material.rest[row(v)] - goal;
                const double distance = dot(r, r);
                if (distance > nearest || (distance == nearest && v >= home)) { continue; }
                nearest = distance;
                home = v;
            }
        }
        if (nearest == 0) { break; }
    }
    return home;
}

void update_home(Cutter& cutter, Index node, std::span<const Index> pairs) {
    SimulationMesh& mesh = cutter.mesh;
    const Index home = find_home(cutter, pairs, mesh.node_reference[row(node)]);
    mesh.node_home.edit(row(node)) = cutter.material.rest[row(home)];
    mesh.node_held.edit(row(node)) = is_held(cutter, pairs, home) ? 1 : 0;
}

} // namespace resect
