// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

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

/// How steeply a vertex off the sheet rises from one on it, above 0 on the side of the normal: rise over
/// squared distance, 1/m, the more certain the greater. The sheet is curved, and says little of what lies
/// along it or far away.
double find_steepness(const Cutter& cutter, const Blade& blade, Index vertex, Index foot) {
    const Vec3 away = cutter.material.rest[row(vertex)] - cutter.material.rest[row(foot)];
    return dot(blade.sheet[row(foot)].normal, away) / dot(away, away);
}

/// By the corner that a face of the sheet leaves out.
bool is_on_positive_side(const Cutter& cutter, const Blade& blade, const TetFace& at) {
    const Tet& vertex = cutter.material.tet(at.tet).vertex;
    double steepest = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        if (k == at.face) { continue; }
        const double steepness = find_steepness(cutter, blade, vertex[at.face], vertex[k]);
        if (std::abs(steepness) > std::abs(steepest)) { steepest = steepness; }
    }
    return steepest > 0;
}

void tear_face(Cutter& cutter, const TetFace& at, Index side, CutReport& report) {
    MaterialMesh& material = cutter.material;
    Scratch& scratch = cutter.scratch;
    const Index link = material.tet(at.tet).link[at.face];
    const TetFace other = {tet_of(link), face_of(link)};
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
            if (is_zero(blade, apex)) { continue; }
            const bool is_positive = is_on_positive_side(cutter, blade, {m, k});
            tear_face(cutter, {m, k}, is_positive ? blade.stroke : -blade.stroke, report);
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

constexpr double snapped = 0.05;           // grains that a vertex of the sheet may lie off it
constexpr double least_bend_length = 0.25; // grains over which normals can be told apart

/// A face of a cluster of flat tets, seen from the tet beyond it.
struct ClusterFace {
    TetFace at = {};
    double area = 0;
    bool is_positive = false;
    double clearness = 0; // of that: steepness over what may be owed to the sheet's bends and to its snapping
};

/// Vertices of the sheet that edges join to a vertex off it.
void collect_feet(Cutter& cutter, const Blade& blade, Index vertex, Index tet) {
    Scratch& scratch = cutter.scratch;
    scratch.star.clear();
    scratch.walked.clear(cutter.material.tets.size());
    walk_star(cutter.material, vertex, tet, scratch.walked, scratch.star);
    scratch.feet.clear();
    for (const Index m : scratch.star) {
        for (const Index v : cutter.material.tet(m).vertex) {
            if (is_zero(blade, v)) { scratch.feet.push_back(v); }
        }
    }
}

ClusterFace judge_face(Cutter& cutter, const Blade& blade, const TetFace& at) {
    const MaterialMesh& material = cutter.material;
    const Index vertex = material.tet(at.tet).vertex[at.face];
    collect_feet(cutter, blade, vertex, at.tet);
    const std::vector<Index>& feet = cutter.scratch.feet;
    double steepest = 0;
    Index foot = feet.front();
    for (const Index v : feet) {
        const double steepness = find_steepness(cutter, blade, vertex, v);
        if (std::abs(steepness) <= std::abs(steepest)) { continue; }
        steepest = steepness;
        foot = v;
    }
    const double grain = material.grain[row(vertex)];
    double bend = 0; // 1/m
    for (const Index v : feet) {
        const double turn = length(blade.sheet[row(v)].normal - blade.sheet[row(foot)].normal);
        const double over = length(material.rest[row(v)] - material.rest[row(foot)]);
        bend = std::max(bend, turn / std::max(over, least_bend_length * grain));
    }
    const double distance = length(material.rest[row(vertex)] - material.rest[row(foot)]);
    const double doubt = bend + snapped * grain / (distance * distance);
    return {at, length(face_normal(material, at.tet, at.face)), steepest > 0, std::abs(steepest) / doubt};
}

std::vector<ClusterFace> list_cluster_faces(Cutter& cutter, const Blade& blade) {
    std::vector<ClusterFace> faces; // clusters are few and small
    for (const Index m : cutter.scratch.cluster) {
        for (const Index link : cutter.material.tet(m).link) {
            if (link < 0 || is_flat(blade, cutter.material.tet(tet_of(link)).vertex)) { continue; }
            faces.push_back(judge_face(cutter, blade, {tet_of(link), face_of(link)}));
        }
    }
    return faces;
}

/// [side] Area at which the stroke has torn the cluster off the other side already.
std::array<double, 2> sum_torn_area(const Cutter& cutter, const Blade& blade) {
    std::array<double, 2> area = {};
    for (const Index m : cutter.scratch.cluster) {
        const MaterialTet& tet = cutter.material.tet(m);
        for (std::size_t k = 0; k < 4; ++k) {
            if (tet.link[k] >= 0 || std::abs(tet.label[k]) != blade.stroke) { continue; }
            area[tet.label[k] > 0 ? 1 : 0] += length(face_normal(cutter.material, m, k));
        }
    }
    return area;
}

/// Tears a cluster of flat tets off its neighbours on one side, and off those whose side does not show before
/// the blade has passed them: a crack to spare harms less than a bridge. It stays on the side where the
/// stroke has put it already, or else where that leaves less to tear.
void tear_cluster(Cutter& cutter, const Blade& blade, CutReport& report) {
    const std::vector<ClusterFace> faces = list_cluster_faces(cutter, blade);
    double clearest = 0;
    for (const ClusterFace& face : faces) {
        clearest = std::max(clearest, face.clearness);
    }
    const double clear = std::min(1.0, clearest);
    std::array<double, 2> area = {}; // [side]
    for (const ClusterFace& face : faces) {
        if (face.clearness >= clear) { area[face.is_positive ? 1 : 0] += face.area; }
    }
    const std::array<double, 2> torn = sum_torn_area(cutter, blade);
    const bool may_stay = area[torn[1] > torn[0] ? 1 : 0] > 0; // else it would come free
    const bool keeps_positive = torn[0] != torn[1] && may_stay ? torn[1] > torn[0] : area[1] >= area[0];
    for (const ClusterFace& face : faces) {
        if (face.clearness >= clear && face.is_positive == keeps_positive) { continue; }
        tear_face(cutter, face.at, face.is_positive ? blade.stroke : -blade.stroke, report);
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

/// Where a star fell apart, the part of the first seed keeps the vertex, every other part gets its own.
void part_star(Cutter& cutter, std::span<const Scratch::Seed> seeds) {
    Scratch& scratch = cutter.scratch;
    const Index vertex = seeds.front().vertex;
    cutter.material.on_cut.edit(row(vertex)) = 1;
    cutter.material.any_tet.edit(row(vertex)) = seeds.front().tet;
    scratch.walked.clear(cutter.material.tets.size());
    AllMarked are_all_met(scratch.walked, seeds, [](const Scratch::Seed& seed) { return seed.tet; });
    scratch.star.clear();
    walk_star_until(cutter.material, vertex, seeds.front().tet, scratch.walked, scratch.star,
                    [&] { return are_all_met(); });
    while (!are_all_met()) {
        scratch.star.clear();
        walk_star(cutter.material, vertex, are_all_met.next().tet, scratch.walked, scratch.star);
        detach_star(cutter, vertex, scratch.star);
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
