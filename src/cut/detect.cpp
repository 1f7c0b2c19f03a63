// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "cut/stages.hpp"

namespace resect {
namespace {

// Snapping, as shares of the local grain: a vertex that the blade passes this closely lies on the sheet. The
// wider share holds on torn sheets, so that a blade that goes back along its cut uses that cut again.
constexpr double snap_share = 0.03;
constexpr double snap_share_on_cut = 0.05;

double snap_distance(const MaterialMesh& material, Index vertex) {
    return (material.on_cut[row(vertex)] != 0 ? snap_share_on_cut : snap_share) * material.grain[row(vertex)];
}

/// The blade with its snapping distance around it, in the blade's frame.
struct BladeBox {
    double across = 0, length = 0; // m
};

std::uint8_t sides_beyond(const BladeBox& box, const Vec3& p) {
    const bool beyond[6] = {p[0] > box.across, p[0]<-box.across, p[1]> box.across, p[1] < -box.across,
                            p[2]<-box.across, p[2]> box.length + box.across};
    unsigned bits = 0;
    for (unsigned i = 0; i < 6; ++i) {
        bits |= unsigned{beyond[i]} << i;
    }
    return static_cast<std::uint8_t>(bits);
}

void classify_nodes(Cutter& cutter, const Sweep& sweep, const BladeBox& box) {
    const std::size_t count = cutter.mesh.node_reference.size();
    cutter.scratch.node_outside.resize(count);
    for (std::size_t n = 0; n < count; ++n) {
        const Vec3& rest = cutter.body.elements.nodes[row(cutter.mesh.node_reference[n])];
        const auto before = sides_beyond(box, to_frame(sweep.from, rest + to_double(sweep.before[n])));
        const auto after = sides_beyond(box, to_frame(sweep.to, rest + to_double(sweep.after[n])));
        cutter.scratch.node_outside[n] = before & after;
    }
}

/// All corners stay beyond one side of the box, so nothing between them can meet the blade.
bool is_copy_outside(const Cutter& cutter, std::size_t copy) {
    unsigned common = 63;
    for (const Index node : cutter.mesh.copy_node[copy]) {
        common &= cutter.scratch.node_outside[row(node)];
    }
    return common != 0;
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

const Track& track_vertex(Cutter& cutter, const Sweep& sweep, const BladeBox& box, Index vertex) {
    Scratch& scratch = cutter.scratch;
    Track& track = scratch.tracks[row(vertex)];
    if (!scratch.tracked.set(vertex)) { return track; }
    const Vec3 before = to_frame(sweep.from, displaced_position(cutter, vertex, sweep.before));
    const Vec3 after = to_frame(sweep.to, displaced_position(cutter, vertex, sweep.after));
    const double scale = 1 / cutter.unit;
    track.outside = sides_beyond(box, before) & sides_beyond(box, after);
    track.height_before = before[2];
    track.height_after = after[2];
    track.on_grid = is_on_grid(scale * before[0], scale * before[1]) &&
                    is_on_grid(scale * after[0], scale * after[1]) && is_finite(before) && is_finite(after);
    if (!track.on_grid) { return track; }
    track.before = quantise(scale * before[0], scale * before[1]);
    track.after = quantise(scale * after[0], scale * after[1]);

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
        const Hit hit = find_edge_hit(scratch.tracks[row(u)], scratch.tracks[row(w)]);
        if (hit.hit && hit.height >= 0 && hit.height <= sweep.to.length) {
            scratch.events.push_back({u, w, tet, hit.t});
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

void snap_vertices(Cutter& cutter, Blade& blade, const Sweep& sweep) {
    Scratch& scratch = cutter.scratch;
    for (const Index vertex : scratch.near) {
        if (is_zero(blade, vertex)) { continue; }
        const Index tet = cutter.material.any_tet[row(vertex)];
        blade.sheet[row(vertex)] = blade.stroke;
        blade.normal[row(vertex)] =
            find_sheet_normal(cutter, sweep, tet, motion_of(scratch.tracks[row(vertex)]));
        scratch.star.clear();
        scratch.walked.clear(cutter.material.tets.size());
        walk_star(cutter.material, vertex, tet, scratch.walked, scratch.star);
        for (const Index m : scratch.star) {
            queue_tet(cutter, m);
        }
    }
}

/// The first crossing of an edge in a stroke stays; edges with an end on the sheet need none.
void record_crossings(Cutter& cutter, Blade& blade, const Sweep& sweep) {
    const MaterialMesh& material = cutter.material;
    for (const Scratch::Event& event : cutter.scratch.events) {
        if (is_zero(blade, event.u) || is_zero(blade, event.w)) { continue; }
        if (blade.pending.find(event.u, event.w) != nullptr) { continue; }
        const double grain = 0.5 * (material.grain[row(event.u)] + material.grain[row(event.w)]);
        const double edge = length(material.rest[row(event.u)] - material.rest[row(event.w)]);
        const double margin = std::min(0.25, snap_share * grain / edge);
        const GridPoint u = motion_of(cutter.scratch.tracks[row(event.u)]);
        const GridPoint w = motion_of(cutter.scratch.tracks[row(event.w)]);
        const Vec3 normal = find_sheet_normal(cutter, sweep, event.tet, {u.x + w.x, u.y + w.y});
        blade.pending.insert(event.u, event.w, {std::clamp(event.t, margin, 1 - margin), normal});
        queue_ring(cutter, event.u, event.w);
    }
}

} // namespace

void detect_crossings(Cutter& cutter, Blade& blade, const Sweep& sweep, CutReport& report) {
    Scratch& scratch = cutter.scratch;
    const BladeBox box = {snap_share_on_cut * cutter.grain + 1e-6 * cutter.unit, sweep.to.length};
    scratch.near.clear();
    scratch.events.clear();
    scratch.off_grid = 0;
    scratch.tracked.clear(cutter.material.rest.size());
    scratch.tracks.resize(cutter.material.rest.size());
    classify_nodes(cutter, sweep, box);
    for (std::size_t copy = 0; copy < cutter.mesh.copy_node.size(); ++copy) {
        if (is_copy_outside(cutter, copy)) { continue; }
        for (Index m = cutter.first_tet[copy]; m >= 0; m = cutter.material.tet(m).next) {
            find_tet_crossings(cutter, sweep, box, m, report);
        }
    }
    if (scratch.off_grid > 0) { ++report.refused; }
    snap_vertices(cutter, blade, sweep);
    record_crossings(cutter, blade, sweep);
}

} // namespace resect
