// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/assert.hpp"
#include "cut/beside.hpp"
#include "cut/homes.hpp"
#include "cut/stages.hpp"
#include "cut/weigh.hpp"

namespace resect {
namespace {

template <class T>
void sort_unique(std::vector<T>& rows) {
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
        note_changed_copy(cutter, twin);
        delta.copies.push_back({copy, twin});
        ++report.copies_added;
    }
}

void touch(Cutter& cutter, Index copy, std::size_t corner) {
    cutter.scratch.touched.push_back({cutter.mesh.copy_node[row(copy)][corner], make_link(copy, corner)});
}

void note_touched(Cutter& cutter, Index copy, Delta& delta) {
    if (cutter.scratch.noted.set(copy)) { delta.touched_copies.push_back(copy); }
}

/// Touches a corner of all copies of an element. Where they all hang on one node, it bears what it bore
/// before, unless each copy weighs as much as the whole; what is held may change with the first cut.
void touch_element(Cutter& cutter, Index element, std::size_t corner) {
    const Index first = cutter.first_copy[row(element)];
    const bool is_held = !cutter.held_elements.empty() && cutter.held_elements[row(element)] != 0;
    bool stays = cutter.setup.options.weights != Weights::copy && !is_held;
    for (Index c = first; c >= 0; c = cutter.sibling[row(c)]) {
        touch(cutter, c, corner);
        stays = stays && cutter.mesh.copy_node[row(c)][corner] == cutter.mesh.copy_node[row(first)][corner];
    }
    if (stays) { return; }
    for (Index c = first; c >= 0; c = cutter.sibling[row(c)]) {
        cutter.scratch.reweighed.set(cutter.mesh.copy_node[row(c)][corner]);
    }
}

/// Weighs the copies of every element that has more of them now: all their corners are touched.
void weigh_elements(Cutter& cutter, Delta& delta) {
    Scratch& scratch = cutter.scratch;
    sort_unique(scratch.elements);
    scratch.reweighed.clear(cutter.mesh.node_mass.size());
    scratch.noted.clear(cutter.mesh.copy_node.size());
    for (const Index element : scratch.elements) {
        weigh_element(cutter, element);
        for (Index c = cutter.first_copy[row(element)]; c >= 0; c = cutter.sibling[row(c)]) {
            delta.weighed.push_back(c);
            note_touched(cutter, c, delta);
        }
        for (std::size_t corner = 0; corner < 4; ++corner) {
            touch_element(cutter, element, corner);
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
            if (is_on_face) { touch(cutter, tet.copy, corner); }
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

/// Walks the pairs of (copy, corner) that material faces around a node join to one of them, into
/// scratch.pairs, until `is_enough`. They all have that node still, since cuts only part classes.
template <class IsEnough>
void walk_pairs(Cutter& cutter, const Scratch::Touched& seed, IsEnough is_enough) {
    Scratch& scratch = cutter.scratch;
    std::size_t next = scratch.pairs.size();
    scratch.pairs.push_back(seed.pair);
    for (; next < scratch.pairs.size() && !is_enough(); ++next) {
        const Index at = scratch.pairs[next] / 4;
        const std::size_t own_corner = face_of(scratch.pairs[next]);
        for (std::size_t face = 0; face < 4; ++face) {
            if (face == own_corner) { continue; }
            each_beside(cutter, at, face, [&](Index beside) {
                const Index pair = make_link(beside, place_of(cutter.mesh.copy_node[row(beside)], seed.node));
                if (scratch.walked_pairs.set(pair)) { scratch.pairs.push_back(pair); }
            });
        }
    }
}

/// The classes that a node falls into, by the pairs around it that were touched; none if they all hang
/// together still, and bear the same.
void walk_classes_of(Cutter& cutter, std::span<const Scratch::Touched> touched) {
    Scratch& scratch = cutter.scratch;
    const Index node = touched.front().node;
    bool stays = !scratch.reweighed.has(node);
    AllMarked are_all_met(scratch.walked_pairs, touched,
                          [](const Scratch::Touched& one) { return one.pair; });
    for (const Scratch::Touched& seed : touched) {
        if (!scratch.walked_pairs.set(seed.pair)) { continue; }
        const std::size_t begin = scratch.pairs.size();
        walk_pairs(cutter, seed, [&] { return stays && are_all_met(); });
        stays = stays && are_all_met();
        if (stays) {
            scratch.pairs.resize(begin);
            return;
        }
        const double mass = sum_mass(cutter, std::span(scratch.pairs).subspan(begin));
        scratch.classes.push_back({node, mass, begin, scratch.pairs.size()});
    }
}

void walk_classes(Cutter& cutter) {
    Scratch& scratch = cutter.scratch;
    scratch.pairs.clear();
    scratch.classes.clear();
    scratch.walked_pairs.clear(4 * cutter.mesh.copy_node.size());
    sort_unique(scratch.touched);
    const std::span<const Scratch::Touched> all = scratch.touched;
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
        while (end < all.size() && all[end].node == all[begin].node) {
            ++end;
        }
        walk_classes_of(cutter, all.subspan(begin, end - begin));
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
    const auto pairs = std::span(cutter.scratch.pairs).subspan(found.begin, found.end - found.begin);
    for (const Index pair : pairs) {
        const Index copy = pair / 4;
        const std::size_t corner = face_of(pair);
        note_touched(cutter, copy, delta);
        if (cutter.mesh.copy_node[row(copy)][corner] == node) { continue; }
        cutter.mesh.copy_node.edit(row(copy))[corner] = node;
        note_changed_copy(cutter, copy);
        delta.corners.push_back({copy, static_cast<Index>(corner), node});
    }
    cutter.mesh.node_mass.edit(row(node)) = found.mass;
    update_home(cutter, node, pairs);
    delta.touched_nodes.push_back(node);
}

/// The heaviest of the classes that a node fell into keeps the node, every other gets a new one.
void assign_nodes(Cutter& cutter, Delta& delta, CutReport& report) {
    std::vector<Scratch::NodeClass>& classes = cutter.scratch.classes;
    std::sort(classes.begin(), classes.end(), [](const Scratch::NodeClass& a, const Scratch::NodeClass& b) {
        if (a.node != b.node) { return a.node < b.node; }
        return a.mass != b.mass ? a.mass > b.mass : a.begin < b.begin;
    });
    for (std::size_t i = 0; i < classes.size(); ++i) {
        const bool keeps = i == 0 || classes[i - 1].node != classes[i].node;
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
