// SPDX-License-Identifier: Apache-2.0
#include "cut/separate.hpp"
#include "cut/stages.hpp"

namespace resect {
namespace {

double turned(double t, Index from, Index to) { return from < to ? t : 1 - t; }

/// A crossing by another blade moves to the half of the edge that it lies on.
void hand_down(Blade& blade, const Tet& ends, double t) {
    const auto [u, w, z, unused] = ends;
    const bool on_sheet = is_zero(blade, u) && is_zero(blade, w);
    blade.sheet.push_back(on_sheet ? blade.stroke : 0);
    blade.normal.push_back(on_sheet ? direction(blade.normal[row(u)] + blade.normal[row(w)]) : Vec3{});
    const Crossing* found = blade.pending.find(u, w);
    if (found == nullptr) { return; }
    Crossing crossing = *found;
    blade.pending.erase(u, w);
    const double s = turned(crossing.t, u, w);
    const Index end = s < t ? u : w;
    const double from_end = s < t ? s / t : (1 - s) / (1 - t);
    crossing.t = turned(from_end, end, z);
    blade.pending.insert(end, z, crossing);
}

void add_to_blades(Cutter& cutter, const Blade& cutting, const Tet& ends, double t, const Vec3& normal) {
    for (Blade& blade : cutter.blades) {
        if (!blade.placed) { continue; }
        if (&blade != &cutting) {
            hand_down(blade, ends, t);
            continue;
        }
        blade.sheet.push_back(blade.stroke);
        blade.normal.push_back(normal);
        blade.pending.erase(ends[0], ends[1]);
    }
}

/// Broken faces may part the tets around the new vertex: each part but the first gets one of its own.
void part_new_vertex(Cutter& cutter, Index z, std::span<const Index> around) {
    Scratch& scratch = cutter.scratch;
    scratch.walked.clear(cutter.material.tets.size());
    for (std::size_t i = 0; i < around.size(); ++i) {
        if (scratch.walked.has(around[i])) { continue; }
        scratch.star.clear();
        walk_star(cutter.material, z, around[i], scratch.walked, scratch.star);
        if (i > 0) { detach_star(cutter, z, scratch.star); }
    }
}

void cut_edge(Cutter& cutter, const Blade& blade, Index u, Index w) {
    Scratch& scratch = cutter.scratch;
    const Crossing crossing = blade.pending.at(u, w);
    const double t = turned(crossing.t, u, w);
    find_ring(cutter.material, u, w, scratch.walked, scratch.ring);
    const Index first = cutter.material.tet_count();
    const Index z = bisect_edge(cutter.material, u, w, t, scratch.ring);
    add_to_blades(cutter, blade, {u, w, z, -1}, t, crossing.normal);
    scratch.queued.grow(cutter.material.tets.size());
    for (const Index m : scratch.ring) {
        queue_tet(cutter, m);
    }
    for (Index m = first; m < cutter.material.tet_count(); ++m) {
        queue_tet(cutter, m);
    }
    part_new_vertex(cutter, z, scratch.ring);
    ++cutter.scratch.bisections;
}

void cut_tet(Cutter& cutter, const Blade& blade, Index tet) {
    const Tet vertex = cutter.material.tet(tet).vertex;
    unsigned zero = 0;
    unsigned crossed = 0;
    for (unsigned k = 0; k < 4; ++k) {
        zero |= unsigned{is_zero(blade, vertex[k])} << k;
    }
    if (blade.pending.size() > 0) {
        for (unsigned e = 0; e < 6; ++e) {
            const auto& [a, b] = edge_corners[e];
            crossed |= unsigned{blade.pending.find(vertex[row(a)], vertex[row(b)]) != nullptr} << e;
        }
    }
    const unsigned side = find_side(zero, crossed);
    if (side == 0) { return; }
    for (unsigned a = 0; a < 4; ++a) {
        for (unsigned b = 0; b < 4; ++b) {
            const bool parts = ((side >> a) & 1U) != 0 && (((side | zero) >> b) & 1U) == 0;
            if (parts) { cut_edge(cutter, blade, vertex[a], vertex[b]); }
        }
    }
}

} // namespace

void queue_tet(Cutter& cutter, Index tet) {
    Scratch& scratch = cutter.scratch;
    scratch.queue.push_back(tet);
    if (scratch.queued.set(tet)) { scratch.dirty.push_back(tet); }
}

void queue_ring(Cutter& cutter, Index u, Index w) {
    find_ring(cutter.material, u, w, cutter.scratch.walked, cutter.scratch.ring);
    for (const Index m : cutter.scratch.ring) {
        queue_tet(cutter, m);
    }
}

void detach_star(Cutter& cutter, Index vertex, std::span<const Index> star) {
    const Index twin = split_vertex(cutter.material, vertex, star);
    for (Blade& blade : cutter.blades) {
        if (!blade.placed) { continue; }
        blade.sheet.push_back(blade.sheet[row(vertex)]);
        blade.normal.push_back(blade.normal[row(vertex)]);
        if (blade.pending.size() == 0) { continue; }
        for (const Index m : star) {
            for (const Index other : cutter.material.tet(m).vertex) {
                if (other == twin) { continue; }
                const Crossing* found = blade.pending.find(vertex, other);
                if (found == nullptr) { continue; }
                Crossing crossing = *found;
                crossing.t = turned(turned(crossing.t, vertex, other), twin, other);
                blade.pending.insert(twin, other, crossing);
            }
        }
    }
}

void bisect_separated(Cutter& cutter, Blade& blade) {
    Scratch& scratch = cutter.scratch;
    while (!scratch.queue.empty()) {
        const Index tet = scratch.queue.back();
        scratch.queue.pop_back();
        cut_tet(cutter, blade, tet);
    }
}

} // namespace resect
