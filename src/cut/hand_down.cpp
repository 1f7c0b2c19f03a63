// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "cut/stages.hpp"

// What a blade knows of edges that another bisects while both are at work: its crossings move to the halves,
// and edges that come into being behind it get those that it would have made.
namespace resect {
namespace {

/// The edge that comes into being from z, on the bisected edge (u, w), to a vertex x around that.
struct NewEdge {
    Index u = 0, w = 0, z = 0, x = 0;
};

double turned(double t, Index from, Index to) { return from < to ? t : 1 - t; }

bool is_crossed(const Blade& blade, Index a, Index b) { return find_crossing(blade, a, b) != nullptr; }

/// The blade's edge passes through the triangle as it is now, by the same decision as its sweeps.
bool is_in_triangle(const Cutter& cutter, const Blade& blade, const std::array<Index, 3>& triangle) {
    std::array<GridPoint, 3> on_grid = {};
    double lowest = blade.frame.length;
    double highest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = to_frame(blade.frame, displaced_position(cutter, triangle[k], cutter.scratch.tissue));
        const double scale = 1 / cutter.unit;
        if (!is_on_grid(scale * p[0], scale * p[1])) { return false; }
        on_grid[k] = quantise(scale * p[0], scale * p[1]);
        lowest = std::min(lowest, p[2]);
        highest = std::max(highest, p[2]);
    }
    return lowest < blade.frame.length && highest > 0 && holds_origin(on_grid[0], on_grid[1], on_grid[2]);
}

/// A sheet that enters a triangle through one side leaves it through another, or the blade is in there now.
/// Triangles with a corner on the sheet do not tell.
bool has_been_crossed(const Cutter& cutter, const Blade& blade, const NewEdge& edge) {
    const auto [u, w, z, x] = edge;
    const bool near_odd = is_crossed(blade, u, z) != is_crossed(blade, u, x);
    const bool far_odd = is_crossed(blade, z, w) != is_crossed(blade, w, x);
    const bool by_near = !is_zero(blade, u) && near_odd != is_in_triangle(cutter, blade, {u, z, x});
    const bool by_far = !is_zero(blade, w) && far_odd != is_in_triangle(cutter, blade, {z, w, x});
    return by_near || by_far; // they differ where the sheet ends beside the tip: rather a crack than a bridge
}

/// A point of the sheet and its plane there.
struct Contact {
    Vec3 point = {};
    Crossing crossing = {};
};

/// Where the sheet meets the triangle's other sides and corners.
std::vector<Contact> list_contacts(const Cutter& cutter, const Blade& blade, const NewEdge& edge) {
    const MaterialMesh& material = cutter.material;
    const auto [u, w, z, x] = edge;
    const std::array<std::array<Index, 2>, 4> sides = {{{u, z}, {u, x}, {z, w}, {w, x}}};
    std::vector<Contact> contacts; // few, and only where two blades meet
    for (const auto& [a, b] : sides) {
        const Crossing* found = find_crossing(blade, a, b);
        if (found == nullptr) { continue; }
        const Vec3& low = material.rest[row(std::min(a, b))];
        const Vec3& high = material.rest[row(std::max(a, b))];
        contacts.push_back({(1 - found->t) * low + found->t * high, *found});
    }
    for (const Index v : {u, w}) {
        if (!is_zero(blade, v)) { continue; }
        const SheetMark& mark = blade.sheet[row(v)];
        contacts.push_back({material.rest[row(v)], {.expires = mark.expires, .normal = mark.normal}});
    }
    return contacts;
}

/// Whether the sheet passes z so closely that z lies on it.
bool is_on_sheet(const MaterialMesh& material, const Contact& contact, Index z) {
    const double rise = dot(contact.crossing.normal, contact.point - material.rest[row(z)]);
    return std::abs(rise) < snap_share * material.grain[row(z)];
}

/// Puts the crossing of a new edge down; true: it lies so near z that z lies on the sheet itself.
bool cross_new_edge(Cutter& cutter, Blade& blade, const NewEdge& edge, std::span<const Contact> contacts) {
    const MaterialMesh& material = cutter.material;
    const Vec3& from = material.rest[row(edge.z)];
    const Vec3 way = material.rest[row(edge.x)] - from;
    const double grain = material.grain[row(edge.z)];
    Crossing crossing = contacts.front().crossing;
    double sum = 0;
    for (const Contact& contact : contacts) {
        if (is_on_sheet(material, contact, edge.z)) {
            blade.sheet.edit(row(edge.z)) = {blade.stroke, crossing.expires, crossing.normal};
            return true;
        }
        const double rise = dot(contact.crossing.normal, contact.point - from);
        const double whole = dot(contact.crossing.normal, way);
        sum += whole != 0 ? std::clamp(rise / whole, 0.0, 1.0) : 0.5;
        if (contact.crossing.height < crossing.height) { crossing = contact.crossing; }
    }
    const double margin = std::min(0.25, snap_share * grain / length(way));
    const double t = std::clamp(sum / static_cast<double>(contacts.size()), margin, 1 - margin);
    crossing.t = turned(t, edge.z, edge.x);
    blade.pending.set(edge.z, edge.x, crossing);
    return false;
}

/// The vertex that bisects an edge lies on a sheet that holds both ends, or crosses the edge near by; else a
/// crossing moves to its half.
void halve_crossing(const MaterialMesh& material, Blade& blade, const Bisection& cut) {
    const auto& [u, w, z, t, first] = cut;
    SheetMark mark;
    if (is_zero(blade, u) && is_zero(blade, w)) {
        const SheetMark& at_u = blade.sheet[row(u)];
        const SheetMark& at_w = blade.sheet[row(w)];
        mark = {blade.stroke, std::min(at_u.expires, at_w.expires), direction(at_u.normal + at_w.normal)};
    }
    const Crossing* found = blade.pending.find(u, w);
    if (found == nullptr) {
        blade.sheet.push_back(mark);
        return;
    }
    Crossing crossing = *found;
    blade.pending.erase(u, w);
    const double s = turned(crossing.t, u, w);
    const Vec3 point = (1 - s) * material.rest[row(u)] + s * material.rest[row(w)];
    if (is_on_sheet(material, {point, crossing}, z)) {
        blade.sheet.push_back({blade.stroke, crossing.expires, crossing.normal});
        return;
    }
    blade.sheet.push_back(mark);
    const Index end = s < t ? u : w;
    const double from_end = s < t ? s / t : (1 - s) / (1 - t);
    crossing.t = turned(from_end, end, z);
    blade.pending.set(end, z, crossing);
}

} // namespace

void hand_down(Cutter& cutter, Blade& blade, const Bisection& cut) {
    halve_crossing(cutter.material, blade, cut);
    const std::vector<Index>& ring = cutter.scratch.ring;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        bool is_begun = false;
        for (const Index x : Tet(cutter.material.tet(ring[i]).vertex)) {
            const NewEdge edge = {cut.u, cut.w, cut.z, x};
            if (x == cut.u || x == cut.z) { continue; }
            const std::vector<Contact> contacts = list_contacts(cutter, blade, edge);
            if (contacts.empty()) { continue; }
            is_begun = true;
            if (is_zero(blade, edge.z) || is_zero(blade, x) || is_crossed(blade, edge.z, x)) { continue; }
            if (!has_been_crossed(cutter, blade, edge)) { continue; }
            if (!cross_new_edge(cutter, blade, edge, contacts)) { continue; }
            blade.pending.erase(cut.u, cut.z);
            blade.pending.erase(cut.w, cut.z);
        }
        if (is_begun) {
            blade.waiting.insert(blade.waiting.end(), {ring[i], cut.first + static_cast<Index>(i)});
        }
    }
}

void queue_waiting(Cutter& cutter, Blade& blade) {
    for (const Index tet : blade.waiting) {
        if (tet < cutter.material.tet_count()) { queue_tet(cutter, tet); }
    }
    blade.waiting.clear();
}

} // namespace resect
