// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/assert.hpp"
#include "cut/beside.hpp"
#include "cut/homes.hpp"
#include "cut/stages.hpp"
#include "cut/weigh.hpp"

namespace resect {
namespace {

void sort_unique(std::vector<Index>& rows) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
}

/// Connected parts of a copy's material, in part_tets.
void find_parts(Cutter& cutter, Index copy) {
    Scratch& scratch = cutter.scratch;
    const MaterialMesh& material = cutter.material;
    scratch.part_tets.clear();
    scratch.parts.clear();
    scratch.walked.clear(material.tets.size());
    for (Index seed = cutter.first_tet[row(copy)]; seed >= 0; seed = material.tet(seed).next) {
        if (!scratch.walked.set(seed)) { continue; }
        Scratch::Part part = {scratch.part_tets.size(), 0, 0};
        scratch.part_tets.push_back(seed);
        for (std::size_t next = part.begin; next < scratch.part_tets.size(); ++next) {
            const MaterialTet& tet = material.tet(scratch.part_tets[next]);
            part.volume += tet.volume;
            for (const Index link : tet.link) {
                if (link < 0 || material.tet(tet_of(link)).copy != copy) { continue; }
                if (scratch.walked.set(tet_of(link))) { scratch.part_tets.push_back(tet_of(link)); }
            }
        }
        part.end = scratch.part_tets.size();
        scratch.parts.push_back(part);
    }
}

Index append_copy(Cutter& cutter, Index parent) {
    SimulationMesh& mesh = cutter.mesh;
    const auto copy = static_cast<Index>(mesh.copy_node.size());
    mesh.copy_node.push_back(mesh.copy_node[row(parent)]);
    mesh.copy_element.push_back(mesh.copy_element[row(parent)]);
    mesh.copy_fraction.push_back(0);
    mesh.copy_weight.push_back(0);
    cutter.first_tet.push_back(-1);
    cutter.sibling.push_back(cutter.sibling[row(parent)]);
    cutter.sibling.edit(row(parent)) = copy;
    cutter.beside.push_back({});
    cutter.pieces.of_copy.push_back(cutter.pieces.of_copy[row(parent)]);
    return copy;
}

/// Gives a part of the material to a copy.
void fill_copy(Cutter& cutter, Index copy, const Scratch::Part& part) {
    Index next = -1;
    for (std::size_t i = part.end; i > part.begin; --i) {
        const Index m = cutter.scratch.part_tets[i - 1];
        MaterialTet& tet = cutter.material.edit_tet(m);
        tet.copy = copy;
        tet.next = next;
        next = m;
    }
    cutter.first_tet.edit(row(copy)) = next;
    const std::size_t element = row(cutter.mesh.copy_element[row(copy)]);
    cutter.mesh.copy_fraction.edit(row(copy)) = part.volume / cutter.element_volume[element];
}

bool has_one_copy(const Cutter& cutter, Index element) {
    return cutter.sibling[row(cutter.first_copy[row(element)])] < 0;
}

/// A copy whose material fell apart: the largest part keeps the copy, every other gets a new one.
void part_copy(Cutter& cutter, Index copy, Delta& delta, CutReport& report) {
    Scratch& scratch = cutter.scratch;
    find_parts(cutter, copy);
    if (scratch.parts.size() == 1) { return; }
    const Index element = cutter.mesh.copy_element[row(copy)];
    if (has_one_copy(cutter, element)) { ++report.elements_cut; }
    scratch.elements.push_back(element);
    const auto largest =
        std::max_element(scratch.parts.begin(), scratch.parts.end(),
                         [](const Scratch::Part& a, const Scratch::Part& b) { return a.volume < b.volume; });
    for (auto part = scratch.parts.begin(); part != scratch.parts.end(); ++part) {
        if (part == largest) {
            fill_copy(cutter, copy, *part);
            continue;
        }
        const Index twin = append_copy(cutter, copy);
        fill_copy(cutter, twin, *part);
        delta.copies.push_back({copy, twin});
        ++report.copies_added;
    }
}

/// Weighs the copies of every element that has more of them now: all their corners are touched.
void weigh_elements(Cutter& cutter, Delta& delta) {
    Scratch& scratch = cutter.scratch;
    sort_unique(scratch.elements);
    scratch.changed.clear(cutter.mesh.copy_node.size());
    for (const Index element : scratch.elements) {
        weigh_element(cutter, element);
        for (Index c = cutter.first_copy[row(element)]; c >= 0; c = cutter.sibling[row(c)]) {
            scratch.changed.set(c);
            delta.weighed.push_back(c);
            for (std::size_t corner = 0; corner < 4; ++corner) {
                scratch.touched.push_back(make_link(c, corner));
            }
        }
    }
    std::sort(delta.weighed.begin(), delta.weighed.end());
}

/// Corners around which a torn face parts two elements.
void touch_torn_corners(Cutter& cutter) {
    for (const TetFace& at : cutter.scratch.torn) {
        const MaterialTet& tet = cutter.material.tet(at.tet);
        if (tet.element_face[at.face] < 0) { continue; }
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const bool is_on_face = corner != std::size_t(tet.element_face[at.face]);
            if (is_on_face) { cutter.scratch.touched.push_back(make_link(tet.copy, corner)); }
        }
    }
}

void find_beside_anew(Cutter& cutter, Index copy) {
    if (cutter.scratch.relisted.set(copy)) { cutter.beside.edit(row(copy)) = find_beside(cutter, copy); }
}

/// Of copies that were parted or torn off at an element's face, and of all that they meet or met.
void update_beside(Cutter& cutter, const Delta& delta) {
    Scratch& scratch = cutter.scratch;
    scratch.relisted.clear(cutter.mesh.copy_node.size());
    const auto with_neighbours = [&](Index copy) {
        for (Index m = cutter.first_tet[row(copy)]; m >= 0; m = cutter.material.tet(m).next) {
            const MaterialTet& tet = cutter.material.tet(m);
            for (std::size_t k = 0; k < 4; ++k) {
                if (tet.link[k] < 0 || tet.element_face[k] < 0) { continue; }
                find_beside_anew(cutter, cutter.material.tet(tet_of(tet.link[k])).copy);
            }
        }
        find_beside_anew(cutter, copy);
    };
    for (const Delta::NewCopy& added : delta.copies) {
        with_neighbours(added.parent);
        with_neighbours(added.copy);
    }
    for (const TetFace& at : scratch.torn) {
        const MaterialTet& tet = cutter.material.tet(at.tet);
        if (tet.element_face[at.face] >= 0) { find_beside_anew(cutter, tet.copy); }
    }
}

/// The corner of a tet that is `node`, which it has.
std::size_t place_of(const Tet& tet, Index node) {
    return (tet[1] == node ? 1U : 0U) + (tet[2] == node ? 2U : 0U) + (tet[3] == node ? 3U : 0U);
}

/// The class of a (copy, corner): the pairs that material faces around its node join to it. They all have
/// that node still, since cuts only part classes.
void walk_class(Cutter& cutter, Index copy, std::size_t corner) {
    Scratch& scratch = cutter.scratch;
    Scratch::NodeClass found = {.node = cutter.mesh.copy_node[row(copy)][corner],
                                .mass = 0,
                                .begin = static_cast<Index>(scratch.pairs.size()),
                                .end = 0,
                                .changed = false};
    scratch.pairs.push_back(make_link(copy, corner));
    for (std::size_t next = row(found.begin); next < scratch.pairs.size(); ++next) {
        const Index at = scratch.pairs[next] / 4;
        const std::size_t own_corner = face_of(scratch.pairs[next]);
        found.changed = found.changed || scratch.changed.has(at);
        for (std::size_t face = 0; face < 4; ++face) {
            if (face == own_corner) { continue; }
            each_beside(cutter, at, face, [&](Index beside) {
                const Index pair =
                    make_link(beside, place_of(cutter.mesh.copy_node[row(beside)], found.node));
                if (scratch.walked_pairs.set(pair)) { scratch.pairs.push_back(pair); }
            });
        }
    }
    found.end = static_cast<Index>(scratch.pairs.size());
    found.mass = sum_mass(cutter, std::span(scratch.pairs).subspan(row(found.begin)));
    scratch.classes.push_back(found);
}

void walk_classes(Cutter& cutter) {
    Scratch& scratch = cutter.scratch;
    const std::size_t copies = cutter.mesh.copy_node.size();
    scratch.pairs.clear();
    scratch.classes.clear();
    scratch.walked_pairs.clear(4 * copies);
    sort_unique(scratch.touched);
    for (const Index pair : scratch.touched) {
        if (scratch.walked_pairs.set(pair)) { walk_class(cutter, pair / 4, face_of(pair)); }
    }
}

Index append_node(Cutter& cutter, Index source) {
    SimulationMesh& mesh = cutter.mesh;
    mesh.node_reference.push_back(mesh.node_reference[row(source)]);
    mesh.node_mass.push_back(0);
    mesh.node_home.push_back({});
    mesh.node_held.push_back(0);
    return static_cast<Index>(mesh.node_reference.size()) - 1;
}

void write_class(Cutter& cutter, const Scratch::NodeClass& found, Index node, Delta& delta) {
    const auto pairs =
        std::span(cutter.scratch.pairs).subspan(row(found.begin), row(found.end - found.begin));
    for (const Index pair : pairs) {
        const Index copy = pair / 4;
        const std::size_t corner = face_of(pair);
        if (cutter.scratch.hung.set(copy)) { delta.touched_copies.push_back(copy); }
        if (cutter.mesh.copy_node[row(copy)][corner] == node) { continue; }
        cutter.mesh.copy_node.edit(row(copy))[corner] = node;
        note_new_node(cutter, copy);
        delta.corners.push_back({copy, static_cast<Index>(corner), node});
    }
    cutter.mesh.node_mass.edit(row(node)) = found.mass;
    update_home(cutter, node, pairs);
    delta.touched_nodes.push_back(node);
}

/// The heaviest of the classes that a node fell into keeps the node, every other gets a new one.
void assign_nodes(Cutter& cutter, Delta& delta, CutReport& report) {
    std::vector<Scratch::NodeClass>& classes = cutter.scratch.classes;
    cutter.scratch.hung.clear(cutter.mesh.copy_node.size());
    std::sort(classes.begin(), classes.end(), [](const Scratch::NodeClass& a, const Scratch::NodeClass& b) {
        if (a.node != b.node) { return a.node < b.node; }
        return a.mass != b.mass ? a.mass > b.mass : a.begin < b.begin;
    });
    for (std::size_t i = 0; i < classes.size(); ++i) {
        const bool keeps = i == 0 || classes[i - 1].node != classes[i].node;
        const bool alone = keeps && (i + 1 == classes.size() || classes[i + 1].node != classes[i].node);
        if (alone && !classes[i].changed) { continue; }
        Index node = classes[i].node;
        if (!keeps) {
            node = append_node(cutter, classes[i].node);
            delta.nodes.push_back({classes[i].node, node});
            ++report.nodes_added;
        }
        write_class(cutter, classes[i], node, delta);
    }
}

} // namespace

void derive_simulation(Cutter& cutter, Delta& delta, CutReport& report) {
    Scratch& scratch = cutter.scratch;
    scratch.parted.clear();
    scratch.touched.clear();
    scratch.elements.clear();
    for (const TetFace& at : scratch.torn) {
        scratch.parted.push_back(cutter.material.tet(at.tet).copy);
    }
    sort_unique(scratch.parted);
    for (const Index copy : scratch.parted) {
        part_copy(cutter, copy, delta, report);
    }
    weigh_elements(cutter, delta);
    touch_torn_corners(cutter);
    update_beside(cutter, delta);
    walk_classes(cutter);
    assign_nodes(cutter, delta, report);
}

} // namespace resect
