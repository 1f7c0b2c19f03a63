// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "cut/beside.hpp"
#include "cut/stages.hpp"
#include "cut/weigh.hpp"

// The checks that every increment passes, in every build: of the rows that it changed, whatever they tell of
// themselves and of their neighbours. find_broken_invariant (validate.cpp) checks the rest.
namespace resect {
namespace {

using Fault = const char*; // null: none

Fault check_tet_volume(const Cutter& cutter, const MaterialTet& tet) {
    const MaterialMesh& material = cutter.material;
    const double volume =
        signed_volume(material.at(tet, 0), material.at(tet, 1), material.at(tet, 2), material.at(tet, 3));
    const double element = cutter.element_volume[row(cutter.mesh.copy_element[row(tet.copy)])];
    if (!(tet.volume > 0)) { return "material would get no volume"; }
    if (!(std::abs(volume - tet.volume) <= 1e-6 * tet.volume + 1e-11 * element)) {
        return "volume would be lost";
    }
    return nullptr;
}

/// Differs between faces of different vertices, but for rare chances.
std::int64_t sum_of_face(const MaterialTet& tet, std::size_t face) {
    std::int64_t sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        if (k != face) { sum += tet.vertex[k]; }
    }
    return sum;
}

/// Linked tets know of each other and share three corners.
Fault check_link(const Cutter& cutter, Index t, std::size_t k) {
    const MaterialTet& tet = cutter.material.tet(t);
    const Index link = tet.link[k];
    const MaterialTet& other = cutter.material.tet(tet_of(link));
    if (other.link[face_of(link)] != make_link(t, k)) { return "tets would be linked one way only"; }
    if (sum_of_face(tet, k) != sum_of_face(other, face_of(link))) {
        return "linked tets would share no face";
    }
    return nullptr;
}

Fault check_tet(const Cutter& cutter, Index t) {
    const MaterialTet& tet = cutter.material.tet(t);
    for (const Index v : tet.vertex) {
        const Index any = cutter.material.any_tet[row(v)];
        if (corner_of(cutter.material.tet(any).vertex, v) == 4) { return "a vertex would lose its tets"; }
    }
    for (std::size_t k = 0; k < 4; ++k) {
        if (tet.link[k] < 0) { continue; }
        if (const Fault fault = check_link(cutter, t, k)) { return fault; }
    }
    return check_tet_volume(cutter, tet);
}

/// The copies of an element share out its material and its weight.
Fault check_element(const Cutter& cutter, Index element) {
    const SimulationMesh& mesh = cutter.mesh;
    const double fill = cutter.element_fill[row(element)];
    const Index first = cutter.first_copy[row(element)];
    double share = 0;
    double weight = 0;
    Index count = 0;
    for (Index c = first; c >= 0; c = cutter.sibling[row(c)]) {
        share += mesh.copy_fraction[row(c)];
        weight += mesh.copy_weight[row(c)];
        ++count;
    }
    const double floor = weight_floor(count);
    for (Index c = first; c >= 0; c = cutter.sibling[row(c)]) {
        if (!(mesh.copy_weight[row(c)] >= (1 - 1e-12) * floor * cutter.element_weight[row(element)])) {
            return "a copy would weigh less than its floor";
        }
    }
    const double whole = cutter.setup.options.weights == Weights::copy ? count : 1;
    if (!(std::abs(share - fill) <= 1e-12)) { return "the copies of an element would not fill it"; }
    if (!(std::abs(weight - whole * cutter.element_weight[row(element)]) <= 1e-12 * whole)) {
        return "mass would be lost or made";
    }
    return nullptr;
}

Fault check_node(const Cutter& cutter, Index node) {
    const double mass = cutter.mesh.node_mass[row(node)];
    return mass > 0 && std::isfinite(mass) ? nullptr : "a node would have no mass";
}

/// Copies that meet at an element's face share its nodes: so nothing tears where nothing was cut.
bool shares_nodes(const Cutter& cutter, Index copy, std::size_t face) {
    const Tet& nodes = cutter.mesh.copy_node[row(copy)];
    bool shares = true;
    each_beside(cutter, copy, face, [&](Index other) {
        for (std::size_t k = 0; k < 4; ++k) {
            if (k == face) { continue; }
            const std::size_t place = corner_of(cutter.element(other), cutter.element(copy)[k]);
            shares = shares && place < 4 && cutter.mesh.copy_node[row(other)][place] == nodes[k];
        }
    });
    return shares;
}

Fault check_copy(const Cutter& cutter, Index copy) {
    const Tet& nodes = cutter.mesh.copy_node[row(copy)];
    for (std::size_t k = 0; k < 4; ++k) {
        if (cutter.mesh.node_reference[row(nodes[k])] != cutter.element(copy)[k]) {
            return "a copy would hang on a node of another place";
        }
        if (!shares_nodes(cutter, copy, k)) { return "the surface would tear apart where nothing was cut"; }
    }
    return nullptr;
}

} // namespace

const char* find_fault(const Cutter& cutter) {
    Fault fault = nullptr;
    const auto note = [&fault](Fault found) {
        if (fault == nullptr) { fault = found; }
    };
    cutter.material.tets.each_changed([&](std::size_t t) { note(check_tet(cutter, static_cast<Index>(t))); });
    cutter.mesh.copy_node.each_changed(
        [&](std::size_t c) { note(check_copy(cutter, static_cast<Index>(c))); });
    cutter.mesh.copy_weight.each_changed(
        [&](std::size_t c) { note(check_element(cutter, cutter.mesh.copy_element[c])); });
    cutter.mesh.node_mass.each_changed(
        [&](std::size_t n) { note(check_node(cutter, static_cast<Index>(n))); });
    return fault;
}

} // namespace resect
