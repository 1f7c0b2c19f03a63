// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "cut/separate.hpp"
#include "cut/soft_tip.hpp"
#include "cut/stages.hpp"

namespace resect {
namespace {

/// Of one increment; more would be a runaway.
constexpr Index bisections_at_most = 1000000;

double turned(double t, Index from, Index to) { return from < to ? t : 1 - t; }

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

/// The state of a tet for find_side.
struct TetState {
    unsigned zero = 0, hard = 0, soft = 0; // a bit for each corner; for each edge
};

TetState find_state(const Blade& blade, const Tet& vertex) {
    TetState state;
    for (unsigned k = 0; k < 4; ++k) {
        state.zero |= unsigned{is_zero(blade, vertex[k])} << k;
    }
    if (blade.pending.size() == 0) { return state; }
    for (unsigned e = 0; e < 6; ++e) {
        const auto& [a, b] = edge_corners[e];
        const Crossing* found = find_crossing(blade, vertex[row(a)], vertex[row(b)]);
        if (found == nullptr) { continue; }
        (found->is_soft ? state.soft : state.hard) |= 1U << e;
    }
    return state;
}

/// What a tet becomes as its edges are bisected.
struct TetParts {
    std::array<Index, 8> tet = {};
    std::size_t count = 0;
};

Index find_holder(const MaterialMesh& material, const TetParts& parts, Index u, Index w) {
    std::size_t at = 0;
    while (corner_of(material.tet(parts.tet[at]).vertex, u) == 4 ||
           corner_of(material.tet(parts.tet[at]).vertex, w) == 4) {
        ++at;
    }
    return parts.tet[at];
}

/// Bisects a crossed edge of one of the parts, which become more.
void cut_part(Cutter& cutter, const Blade& blade, TetParts& parts, Index u, Index w) {
    const Crossing crossing = blade.pending.at(u, w);
    const MaterialEdge edge = {u, w, find_holder(cutter.material, parts, u, w)};
    const Index first = cut_edge(cutter, edge, turned(crossing.t, u, w), {&blade, crossing});
    const std::vector<Index>& ring = cutter.scratch.ring;
    for (std::size_t i = 0, whole = parts.count; i < whole; ++i) {
        const auto at = std::find(ring.begin(), ring.end(), parts.tet[i]);
        if (at != ring.end()) { parts.tet[parts.count++] = first + static_cast<Index>(at - ring.begin()); }
    }
}

void cut_tet(Cutter& cutter, const Blade& blade, Index tet) {
    const Tet vertex = cutter.material.tet(tet).vertex;
    const TetState state = find_state(blade, vertex);
    Separation parted = {find_side(state.zero, state.hard), state.zero};
    if (parted.side == 0 && state.soft != 0) {
        parted.side = find_side(state.zero, state.hard | state.soft);
        if (parted.side != 0 && !reaches_deep(cutter, blade, vertex, parted)) { return; }
    }
    if (parted.side == 0) { return; }
    TetParts parts = {{tet}, 1};
    each_parted_edge(
        parted, [&](std::size_t a, std::size_t b) { cut_part(cutter, blade, parts, vertex[a], vertex[b]); });
}

} // namespace

void queue_tet(Cutter& cutter, Index tet) {
    Scratch& scratch = cutter.scratch;
    scratch.queue.push_back(tet);
    if (scratch.queued.set(tet)) { scratch.dirty.push_back(tet); }
}

Index cut_edge(Cutter& cutter, const MaterialEdge& edge, double t, const EdgeCut& cut) {
    Scratch& scratch = cutter.scratch;
    const bool is_closed = find_ring(cutter.material, edge, scratch.walked, scratch.ring);
    const Index first = cutter.material.tet_count();
    const Index z = bisect_edge(cutter.material, edge.u, edge.w, t, scratch.ring);
    for (Blade& blade : cutter.blades) {
        if (!blade.placed) { continue; }
        if (&blade != cut.blade) {
            hand_down(cutter, blade, {edge.u, edge.w, z, t, first});
            continue;
        }
        blade.sheet.push_back({blade.stroke, cut.crossing.expires, cut.crossing.normal});
        blade.pending.erase(edge.u, edge.w);
    }
    scratch.queued.grow(cutter.material.tets.size());
    for (const Index m : scratch.ring) {
        ++cutter.tet_count.edit(row(cutter.element_of(m)));
        queue_tet(cutter, m);
    }
    for (Index m = first; m < cutter.material.tet_count(); ++m) {
        queue_tet(cutter, m);
    }
    if (!is_closed) { part_new_vertex(cutter, z, scratch.ring); }
    ++scratch.bisections;
    return first;
}

void detach_star(Cutter& cutter, Index vertex, std::span<const Index> star) {
    const Index twin = split_vertex(cutter.material, vertex, star);
    for (Blade& blade : cutter.blades) {
        if (!blade.placed) { continue; }
        const SheetMark mark = blade.sheet[row(vertex)];
        blade.sheet.push_back(mark);
        if (blade.pending.size() == 0) { continue; }
        for (const Index m : star) {
            for (const Index other : cutter.material.tet(m).vertex) {
                if (other == twin) { continue; }
                const Crossing* found = blade.pending.find(vertex, other);
                if (found == nullptr) { continue; }
                Crossing crossing = *found;
                crossing.t = turned(turned(crossing.t, vertex, other), twin, other);
                blade.pending.set(twin, other, crossing);
            }
        }
    }
}

void bisect_separated(Cutter& cutter, const Blade& blade) {
    Scratch& scratch = cutter.scratch;
    while (!scratch.queue.empty() && scratch.bisections < bisections_at_most) {
        const Index tet = scratch.queue.back();
        scratch.queue.pop_back();
        cut_tet(cutter, blade, tet);
    }
    scratch.is_runaway = !scratch.queue.empty();
}

} // namespace resect
