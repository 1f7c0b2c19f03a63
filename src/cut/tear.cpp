// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "cut/stages.hpp"

namespace resect {
namespace {

bool is_face_zero(const Blade& blade, const Tet& vertex, std::size_t face) {
    for (std::size_t k = 0; k < 4; ++k) {
        if (k != face && !is_zero(blade, vertex[k])) { return false; }
    }
    return true;
}

/// All four corners lie on the sheet.
bool is_flat(const Blade& blade, const Tet& vertex) {
    return is_face_zero(blade, vertex, 0) && is_zero(blade, vertex[0]);
}

/// Sum of the sheet's normals at a face's corners.
Vec3 sheet_normal(const Blade& blade, const Tet& vertex, std::size_t face) {
    Vec3 sum = {};
    for (std::size_t k = 0; k < 4; ++k) {
        if (k != face) { sum += blade.sheet[row(vertex[k])].normal; }
    }
    return sum;
}

/// Of the sheet, by the corner that the face leaves out: what lies off the sheet tells the side better than
/// the face itself, which may stand across it.
bool is_on_positive_side(const Cutter& cutter, const Blade& blade, const TetFace& at) {
    const MaterialTet& tet = cutter.material.tet(at.tet);
    Vec3 from_face = 3.0 * cutter.material.at(tet, at.face);
    for (std::size_t k = 0; k < 4; ++k) {
        if (k != at.face) { from_face = from_face - cutter.material.at(tet, k); }
    }
    return dot(sheet_normal(blade, tet.vertex, at.face), from_face) > 0;
}

void tear_face(Cutter& cutter, const Blade& blade, const TetFace& at, CutReport& report) {
    MaterialMesh& material = cutter.material;
    Scratch& scratch = cutter.scratch;
    const Index link = material.tet(at.tet).link[at.face];
    const TetFace other = {tet_of(link), face_of(link)};
    const Index side = is_on_positive_side(cutter, blade, at) ? blade.stroke : -blade.stroke;
    const auto open = [&](const TetFace& face, Index label) {
        MaterialTet& tet = material.edit_tet(face.tet);
        tet.link[face.face] = -1;
        tet.label[face.face] = label;
    };
    open(at, side);
    open(other, -side);
    scratch.torn.push_back(at);
    scratch.torn.push_back(other);
    report.area += 0.5 * length(face_normal(material, at.tet, at.face));
}

/// Faces with three corners on the sheet, between tets that are not flat.
void tear_plain_faces(Cutter& cutter, const Blade& blade, CutReport& report) {
    for (const Index m : cutter.scratch.dirty) {
        const Tet& vertex = cutter.material.tet(m).vertex;
        for (std::size_t k = 0; k < 4; ++k) {
            const Index link = cutter.material.tet(m).link[k];
            if (link < 0 || !is_face_zero(blade, vertex, k) || is_zero(blade, vertex[k])) { continue; }
            const Index apex = cutter.material.tet(tet_of(link)).vertex[face_of(link)];
            if (!is_zero(blade, apex)) { tear_face(cutter, blade, {m, k}, report); }
        }
    }
}

/// The flat tets that links join to `seed`.
void collect_cluster(Cutter& cutter, const Blade& blade, Index seed) {
    Scratch& scratch = cutter.scratch;
    scratch.cluster.assign(1, seed);
    for (std::size_t next = 0; next < scratch.cluster.size(); ++next) {
        for (const Index link : cutter.material.tet(scratch.cluster[next]).link) {
            if (link < 0 || !is_flat(blade, cutter.material.tet(tet_of(link)).vertex)) { continue; }
            if (scratch.in_cluster.set(tet_of(link))) { scratch.cluster.push_back(tet_of(link)); }
        }
    }
}

/// Tears a cluster of flat tets off its neighbours on the side where that is less area, if it has some on
/// both.
void tear_cluster(Cutter& cutter, const Blade& blade, CutReport& report) {
    std::array<std::vector<TetFace>, 2> faces; // [side], clusters are few and small
    std::array<double, 2> area = {};
    for (const Index m : cutter.scratch.cluster) {
        const MaterialTet& tet = cutter.material.tet(m);
        for (std::size_t k = 0; k < 4; ++k) {
            if (tet.link[k] < 0) { continue; }
            const TetFace other = {tet_of(tet.link[k]), face_of(tet.link[k])};
            if (is_flat(blade, cutter.material.tet(other.tet).vertex)) { continue; }
            const std::size_t side = is_on_positive_side(cutter, blade, other) ? 1 : 0;
            faces[side].push_back(other);
            area[side] += length(face_normal(cutter.material, m, k));
        }
    }
    if (faces[0].empty() || faces[1].empty()) { return; }
    for (const TetFace& face : faces[area[0] < area[1] ? 0 : 1]) {
        tear_face(cutter, blade, face, report);
    }
}

void tear_flat_clusters(Cutter& cutter, const Blade& blade, CutReport& report) {
    Scratch& scratch = cutter.scratch;
    scratch.in_cluster.clear(cutter.material.tets.size());
    for (const Index m : scratch.dirty) {
        if (!is_flat(blade, cutter.material.tet(m).vertex) || !scratch.in_cluster.set(m)) { continue; }
        collect_cluster(cutter, blade, m);
        tear_cluster(cutter, blade, report);
    }
}

/// A star that fell apart: the part of the first seed keeps the vertex, every other part gets its own.
void part_star(Cutter& cutter, std::span<const Scratch::Seed> seeds) {
    Scratch& scratch = cutter.scratch;
    const Index vertex = seeds.front().vertex;
    cutter.material.on_cut.edit(row(vertex)) = 1;
    scratch.walked.clear(cutter.material.tets.size());
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        if (scratch.walked.has(seeds[i].tet)) { continue; }
        scratch.star.clear();
        walk_star(cutter.material, vertex, seeds[i].tet, scratch.walked, scratch.star);
        if (i == 0) {
            cutter.material.any_tet.edit(row(vertex)) = seeds[i].tet;
        } else {
            detach_star(cutter, vertex, scratch.star);
        }
    }
}

} // namespace

void part_torn_vertices(Cutter& cutter) {
    std::vector<Scratch::Seed>& seeds = cutter.scratch.seeds;
    seeds.clear();
    for (const TetFace& at : cutter.scratch.torn) {
        for (std::size_t k = 0; k < 4; ++k) {
            if (k != at.face) { seeds.push_back({cutter.material.tet(at.tet).vertex[k], at.tet}); }
        }
    }
    std::sort(seeds.begin(), seeds.end());
    for (std::size_t begin = 0; begin < seeds.size();) {
        std::size_t end = begin;
        while (end < seeds.size() && seeds[end].vertex == seeds[begin].vertex) {
            ++end;
        }
        part_star(cutter, std::span(seeds).subspan(begin, end - begin));
        begin = end;
    }
}

void tear_sheet(Cutter& cutter, Blade& blade, CutReport& report) {
    cutter.scratch.torn.clear();
    tear_plain_faces(cutter, blade, report);
    tear_flat_clusters(cutter, blade, report);
    glue_crumbs(cutter, report);
    part_torn_vertices(cutter);
}

} // namespace resect
