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

bool holds_triangle(const Cutter& cutter, const MaterialTet& tet, std::size_t face) {
    const MaterialMesh& material = cutter.material;
    return std::any_of(cutter.setup.held.begin(), cutter.setup.held.end(), [&](const HeldRegion& region) {
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t v = row(tet.vertex[k]);
            if (k != face && !holds(region, material.rest[v], material.support[v])) { return false; }
        }
        return true;
    });
}

/// The corner of the tet's element that its face is nearest to.
std::size_t find_nearest_corner(const Cutter& cutter, const MaterialTet& tet, std::size_t face) {
    std::array<double, 4> weight = {};
    for (std::size_t k = 0; k < 4; ++k) {
        if (k == face) { continue; }
        const Support& support = cutter.material.support[row(tet.vertex[k])];
        for (std::size_t corner = 0; corner < 4; ++corner) {
            weight[corner] += weight_of(support, cutter.element(tet.copy)[corner]);
        }
    }
    return static_cast<std::size_t>(std::max_element(weight.begin(), weight.end()) - weight.begin());
}

/// The copy has skin on a held face of its element that contains the corner; or, where the element was held
/// before it was cut, other skin in a held region that is nearest to the corner.
bool has_held_skin(const Cutter& cutter, Index copy, std::size_t corner) {
    const std::size_t element = row(cutter.mesh.copy_element[row(copy)]);
    const unsigned faces = cutter.held_faces[element] & ~(1U << corner);
    const bool is_cut = cutter.sibling[row(cutter.first_copy[element])] >= 0;
    const bool counts_all = is_cut && !cutter.held_elements.empty() && cutter.held_elements[element] != 0;
    if (faces == 0 && !counts_all) { return false; }
    for (Index m = cutter.first_tet[row(copy)]; m >= 0; m = cutter.material.tet(m).next) {
        const MaterialTet& tet = cutter.material.tet(m);
        for (std::size_t k = 0; k < 4; ++k) {
            if (tet.link[k] >= 0 || tet.label[k] != 0) { continue; }
            if (tet.element_face[k] >= 0 && ((faces >> unsigned(tet.element_face[k])) & 1U) != 0) {
                return true;
            }
            if (counts_all && find_nearest_corner(cutter, tet, k) == corner &&
                holds_triangle(cutter, tet, k)) {
                return true;
            }
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

void mark_held_elements(Cutter& cutter) {
    std::vector<std::uint8_t> held(cutter.element_volume.size(), 0);
    for (std::size_t copy = 0; copy < cutter.mesh.copy_node.size(); ++copy) {
        for (const Index node : cutter.mesh.copy_node[copy]) {
            held[row(cutter.mesh.copy_element[copy])] |= cutter.mesh.node_held[row(node)];
        }
    }
    cutter.held_elements = std::move(held);
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
