// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "cut/stages.hpp"

namespace resect {
namespace {

/// In place of snap_share on torn sheets, so that a blade that goes back along its cut uses that cut again.
constexpr double snap_share_on_cut = 0.05;
/// The same in elements with `Cutter::crowd` material tets or more; from `most_crowded` times as many on,
/// nothing is bisected.
constexpr double snap_share_in_crowd = 0.25;
constexpr Index most_crowded = 2;

/// How far beyond its tip a blade sees, as a share of the local grain (cutting.md G.3 by way of
/// docs/cutting.md, "Shallow cuts").
constexpr double soft_reach = 1.7;
/// Travel after which marks and crossings expire, in grains: a stroke that comes back to its own cut crosses
/// it as it would another's. In long thin tets it is their longest edge, or a face of one would be forgotten
/// at one end before the blade has come to the other.
constexpr double lifetime = 3, lifetime_in_edges = 1.05;
/// How far from the blade material is refined, in grains.
constexpr double refine_ahead = 0.75;
double snap_distance(const MaterialMesh& material, Index vertex) {
    return (material.on_cut[row(vertex)] != 0 ? snap_share_on_cut : snap_share) * material.grain[row(vertex)];
}

/// Squared distance of the path from the blade's line where it is nearest, and the height there.
struct Passage {
    double distance_squared = 0, height = 0;
};

Passage find_passage(const Vec3& before, const Vec3& after) {
    const double dx = after[0] - before[0];
    const double dy = after[1] - before[1];
    const double run = dx * dx + dy * dy;
    const double s = run > 0 ? std::clamp(-(before[0] * dx + before[1] * dy) / run, 0.0, 1.0) : 0.0;
    const double x = before[0] + s * dx;
    const double y = before[1] + s * dy;
    return {x * x + y * y, before[2] + s * (after[2] - before[2])};
}

/// A bit for each side of each axis across the blade, for a point strictly on it.
std::uint8_t half_planes_of(const GridPoint& p) {
    return static_cast<std::uint8_t>((p.x > 0 ? 1U : 0U) | (p.x < 0 ? 2U : 0U) | (p.y > 0 ? 4U : 0U) |
                                     (p.y < 0 ? 8U : 0U));
}

const Track& track_vertex(Cutter& cutter, const Sweep& sweep, const BladeBox& box, Index vertex) {
    Scratch& scratch = cutter.scratch;
    Track& track = scratch.tracks[row(vertex)];
    if (!scratch.tracked.set(vertex)) { return track; }
    const Vec3 before = to_frame(sweep.from, displaced_position(cutter, vertex, sweep.before));
    const Vec3 after = to_frame(sweep.to, displaced_position(cutter, vertex, sweep.after));
    scratch.least_path =
        std::min(scratch.least_path, length(Vec3{after[0] - before[0], after[1] - before[1], 0}));
    const double scale = 1 / cutter.unit;
    track.outside = sides_beyond(box, before) & sides_beyond(box, after);
    track.height_before = before[2];
    track.height_after = after[2];
    track.on_grid = is_on_grid(scale * before[0], scale * before[1]) &&
                    is_on_grid(scale * after[0], scale * after[1]) && is_finite(before) && is_finite(after);
    if (!track.on_grid) { return track; }
    track.before = quantise(scale * before[0], scale * before[1]);
    track.after = quantise(scale * after[0], scale * after[1]);
    track.half_planes = half_planes_of(track.before) & half_planes_of(track.after);

    const Passage passage = find_passage(before, after);
    const double reach = snap_distance(cutter.material, vertex);
    const bool is_near = passage.distance_squared < reach * reach && passage.height >= -reach &&
                         passage.height <= sweep.to.length + reach;
    if (is_near) { scratch.near.push_back(vertex); }
    return track;
}

/// Whether the blade's line passes through the triangle that a moving point sweeps with a resting one; t is
/// where on the segment between them, from the moving one, and `height` where along the blade.
struct Hit {
    bool hit = false;
    double t = 0, height = 0;
};

struct Moving {
    const GridPoint &from, &to;
    double height_from = 0, height_to = 0;
};

Hit find_hit(const Moving& p, const GridPoint& rest, double height_rest) {
    if (!holds_origin(p.from, p.to, rest)) { return {}; }
    const std::int64_t first = cross(p.from, rest);
    const std::int64_t change = first - cross(p.to, rest);
    const double s =
        change == 0 ? 0.5 : std::clamp(static_cast<double>(first) / static_cast<double>(change), 0.0, 1.0);
    const auto x = static_cast<double>(p.from.x) + s * static_cast<double>(p.to.x - p.from.x);
    const auto y = static_cast<double>(p.from.y) + s * static_cast<double>(p.to.y - p.from.y);
    const double a = std::sqrt(x * x + y * y);
    const double b = std::hypot(static_cast<double>(rest.x), static_cast<double>(rest.y));
    const double t = a + b > 0 ? a / (a + b) : 0.5;
    const double height = (1 - t) * (p.height_from + s * (p.height_to - p.height_from)) + t * height_rest;
    return {true, t, height};
}

/// Vertices move one after the other, the lower first: the edge is crossed if one of its ends carries it over
/// the blade, and not if both do.
Hit find_edge_hit(const Track& u, const Track& w) {
    Hit first = find_hit({u.before, u.after, u.height_before, u.height_after}, w.before, w.height_before);
    Hit second = find_hit({w.before, w.after, w.height_before, w.height_after}, u.after, u.height_after);
    if (first.hit == second.hit) { return {}; }
    if (first.hit) { return first; }
    second.t = 1 - second.t;
    return second;
}

void find_tet_crossings(Cutter& cutter, const Sweep& sweep, const BladeBox& box, Index tet,
                        CutReport& report) {
    Scratch& scratch = cutter.scratch;
    const Tet& vertex = cutter.material.tet(tet).vertex;
    unsigned common = 63;
    bool on_grid = true;
    for (const Index v : vertex) {
        const Track& track = track_vertex(cutter, sweep, box, v);
        common &= track.outside;
        on_grid = on_grid && track.on_grid;
    }
    if (common != 0) { return; }
    if (!on_grid) {
        report.reason = "material that is not finite, or that passed the blade in one great leap, was left "
                        "uncut: move the "
                        "blade in smaller steps";
        report.where = sweep.to.tip;
        ++cutter.scratch.off_grid;
        return;
    }
    for (const auto& corners : edge_corners) {
        const auto [u, w] = std::minmax(vertex[row(corners[0])], vertex[row(corners[1])]);
        const Track& of_u = scratch.tracks[row(u)];
        const Track& of_w = scratch.tracks[row(w)];
        if ((of_u.outside & of_w.outside) != 0) { continue; }
        if ((of_u.half_planes & of_w.half_planes) != 0) { continue; } // no triangle of theirs holds the blade
        const Hit hit = find_edge_hit(of_u, of_w);
        if (hit.hit && hit.height >= -box.beyond_tip && hit.height <= sweep.to.length) {
            scratch.events.push_back({{u, w, tet}, hit.t, hit.height});
        }
    }
}

/// The sheet's normal at rest: across the blade and the motion of the tissue past it, pulled back by the
/// deformation of the tet's element (N = F^T n).
Vec3 find_sheet_normal(const Cutter& cutter, const Sweep& sweep, Index tet, const GridPoint& motion) {
    const auto x = static_cast<double>(motion.x);
    const auto y = static_cast<double>(motion.y);
    const Vec3 n = direction(x * sweep.to.across2 - y * sweep.to.across1);
    const Index copy = cutter.material.tet(tet).copy;
    const std::size_t element = row(cutter.mesh.copy_element[row(copy)]);
    Vec3 pulled = n;
    for (std::size_t k = 0; k < 4; ++k) {
        const auto& [a, b, c] = face_corners[k];
        const Vec3& origin = cutter.body.elements.nodes[row(cutter.element(copy)[row(a)])];
        const Vec3& right = cutter.body.elements.nodes[row(cutter.element(copy)[row(b)])];
        const Vec3& left = cutter.body.elements.nodes[row(cutter.element(copy)[row(c)])];
        const Vec3 gradient =
            (-1 / (6 * cutter.element_volume[element])) * cross(right - origin, left - origin);
        const Index node = cutter.mesh.copy_node[row(copy)][k];
        pulled += dot(n, to_double(sweep.after[row(node)])) * gradient;
    }
    return direction(pulled);
}

GridPoint motion_of(const Track& track) {
    return {track.after.x - track.before.x, track.after.y - track.before.y};
}

double mean_grain(const MaterialMesh& material, const MaterialEdge& edge) {
    return 0.5 * (material.grain[row(edge.u)] + material.grain[row(edge.w)]);
}

double find_longest_edge(const MaterialMesh& material, std::span<const Index> tets) {
    double longest = 0;
    for (const Index m : tets) {
        const Tet& vertex = material.tet(m).vertex;
        for (const auto& [a, b] : edge_corners) {
            const Vec3 edge = material.rest[row(vertex[row(a)])] - material.rest[row(vertex[row(b)])];
            longest = std::max(longest, dot(edge, edge));
        }
    }
    return std::sqrt(longest);
}

/// The travel at which what is noted now about `tets` expires, m.
double find_expiry(const Cutter& cutter, const Blade& blade, double grain, std::span<const Index> tets) {
    const double longest = find_longest_edge(cutter.material, tets);
    return blade.travel + blade.step + std::max(lifetime * grain, lifetime_in_edges * longest);
}

/// Puts a vertex on the sheet, or notes that the blade has passed it again.
void mark_zero(Cutter& cutter, Blade& blade, Index vertex, const Vec3& normal) {
    const bool was_zero = is_zero(blade, vertex);
    SheetMark& mark = blade.sheet.edit(row(vertex));
    const double grain = cutter.material.grain[row(vertex)];
    if (was_zero) {
        mark.expires = std::max(mark.expires, find_expiry(cutter, blade, grain, {}));
        return;
    }
    mark.stroke = blade.stroke;
    mark.normal = normal;
    Scratch& scratch = cutter.scratch;
    scratch.star.clear();
    scratch.walked.clear(cutter.material.tets.size());
    walk_star(cutter.material, vertex, cutter.material.any_tet[row(vertex)], scratch.walked, scratch.star);
    mark.expires = find_expiry(cutter, blade, grain, scratch.star);
    for (const Index m : scratch.star) {
        queue_tet(cutter, m);
    }
}

void snap_vertices(Cutter& cutter, Blade& blade, const Sweep& sweep) {
    for (const Index vertex : cutter.scratch.near) {
        const Index tet = cutter.material.any_tet[row(vertex)];
        const GridPoint motion = motion_of(cutter.scratch.tracks[row(vertex)]);
        mark_zero(cutter, blade, vertex, find_sheet_normal(cutter, sweep, tet, motion));
    }
}

/// How far a vertex may be pulled onto the sheet, m, to spare bisecting the edges `tets` lie around: farther
/// where an element's material has been cut up a lot, and as far as need be where that has gone on
/// regardless.
double reach_of_crowd(const Cutter& cutter, std::span<const Index> tets, double grain) {
    Index most = 0;
    for (const Index tet : tets) {
        most = std::max(most, cutter.tet_count[row(cutter.element_of(tet))]);
    }
    if (most >= most_crowded * cutter.crowd) { return std::numeric_limits<double>::infinity(); }
    return most >= cutter.crowd ? snap_share_in_crowd * grain : 0;
}

/// The first crossing of an edge stays until it expires, but one above the tip takes the place of one beyond
/// it; edges with an end on the sheet need none.
void record_crossing(Cutter& cutter, Blade& blade, const Sweep& sweep, const Scratch::Event& event) {
    const MaterialMesh& material = cutter.material;
    const auto& [u, w, tet] = event.edge;
    if (is_zero(blade, u) || is_zero(blade, w)) { return; }
    const double grain = mean_grain(material, event.edge);
    const bool is_soft = event.height < 0;
    if (is_soft && event.height < -soft_reach * grain) { return; }
    const Crossing* known = find_crossing(blade, u, w);
    if (known != nullptr && (is_soft || !known->is_soft)) { return; }
    const GridPoint of_u = motion_of(cutter.scratch.tracks[row(u)]);
    const GridPoint of_w = motion_of(cutter.scratch.tracks[row(w)]);
    const Vec3 normal = find_sheet_normal(cutter, sweep, tet, {of_u.x + of_w.x, of_u.y + of_w.y});
    std::vector<Index>& ring = cutter.scratch.ring;
    find_ring(cutter.material, event.edge, cutter.scratch.walked, ring);
    const double edge = length(material.rest[row(u)] - material.rest[row(w)]);
    if (std::min(event.t, 1 - event.t) * edge < reach_of_crowd(cutter, ring, grain)) {
        if (!is_soft) { mark_zero(cutter, blade, event.t < 0.5 ? u : w, normal); }
        return;
    }
    const double margin = std::min(0.25, snap_share * grain / edge);
    blade.pending.set(u, w,
                      {.t = std::clamp(event.t, margin, 1 - margin),
                       .height = event.height,
                       .is_soft = is_soft,
                       .expires = find_expiry(cutter, blade, grain, ring),
                       .normal = normal});
    for (const Index m : ring) {
        queue_tet(cutter, m);
    }
}

/// How far the blade goes past the tissue around it where it goes the least: so marks stay fresh where a
/// blade turns, or tissue moves along with it, however far it goes elsewhere. It counts from the next
/// increment on, so that they outlast one however long.
void note_travel(Cutter& cutter, Blade& blade, const Sweep& sweep) {
    const double least = cutter.scratch.least_path;
    blade.travel += blade.step;
    blade.step = std::isfinite(least) ? least : length(sweep.to.tip - sweep.from.tip);
}

} // namespace

BladeBox make_box(const Cutter& cutter, const Sweep& sweep) {
    const double across = snap_share_on_cut * cutter.grain + 1e-6 * cutter.unit;
    const double beyond_tip = cutter.setup.options.front == Front::soft ? soft_reach * cutter.grain : 0;
    const double ahead = cutter.setup.options.refine > 0 ? refine_ahead * cutter.grain : 0;
    return {across, beyond_tip, sweep.to.length, ahead};
}

std::uint8_t sides_beyond(const BladeBox& box, const Vec3& p) {
    const bool beyond[6] = {p[0] > box.across, p[0]<-box.across, p[1]> box.across, p[1] < -box.across,
                            p[2]<-box.beyond_tip - box.across, p[2]> box.length + box.across};
    unsigned bits = 0;
    for (unsigned i = 0; i < 6; ++i) {
        bits |= unsigned{beyond[i]} << i;
    }
    return static_cast<std::uint8_t>(bits);
}

void detect_crossings(Cutter& cutter, Blade& blade, const Sweep& sweep, const BladeBox& box,
                      CutReport& report) {
    Scratch& scratch = cutter.scratch;
    scratch.near.clear();
    scratch.events.clear();
    scratch.off_grid = 0;
    scratch.least_path = std::numeric_limits<double>::infinity();
    scratch.tracked.clear(cutter.material.rest.size());
    if (scratch.tracks.size() < cutter.material.rest.size()) {
        scratch.tracks.resize(2 * cutter.material.rest.size());
    }
    for (const Index copy : scratch.near_copies) {
        for (Index m = cutter.first_tet[row(copy)]; m >= 0; m = cutter.material.tet(m).next) {
            find_tet_crossings(cutter, sweep, box, m, report);
        }
    }
    if (scratch.off_grid > 0) { ++report.refused; }
    note_travel(cutter, blade, sweep);
    snap_vertices(cutter, blade, sweep);
    for (const Scratch::Event& event : scratch.events) {
        record_crossing(cutter, blade, sweep, event);
    }
}

} // namespace resect
