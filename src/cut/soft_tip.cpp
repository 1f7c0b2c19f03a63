// SPDX-License-Identifier: Apache-2.0
#include "cut/soft_tip.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace resect {
namespace {

/// Share of a tet's section that a blade must have passed for the whole to count as cut: sections are then
/// as often too deep as too shallow.
constexpr double deep_enough = 0.25;

struct SectionPoint {
    Vec3 rest = {};
    double height = 0; // m above the tip
};

struct Section {
    std::array<SectionPoint, 4> point = {};
    std::size_t count = 0;
};

/// The polygon in which the sheet meets the tet, in order around it.
Section find_section(const Cutter& cutter, const Blade& blade, const Tet& vertex, const Separation& parted) {
    Section section;
    for (std::size_t k = 0; k < 4; ++k) {
        if (((parted.zero >> k) & 1U) != 0) {
            section.point[section.count++] = {cutter.material.rest[row(vertex[k])], 0};
        }
    }
    each_parted_edge(parted, [&](std::size_t a, std::size_t b) {
        const auto [u, w] = std::minmax(vertex[a], vertex[b]);
        const Crossing& crossing = blade.pending.at(u, w);
        const Vec3& from = cutter.material.rest[row(u)];
        const Vec3& to = cutter.material.rest[row(w)];
        section.point[section.count++] = {(1 - crossing.t) * from + crossing.t * to, crossing.height};
    });
    if (section.count == 4) { std::swap(section.point[2], section.point[3]); }
    return section;
}

/// The part of a triangle that lies above the tip, height being linear in it.
double share_above(std::array<double, 3> height) {
    std::sort(height.begin(), height.end());
    const auto [low, middle, high] = height;
    if (low >= 0) { return 1; }
    if (high <= 0) { return 0; }
    if (middle <= 0) { return high / (high - low) * (high / (high - middle)); }
    return 1 - low / (low - high) * (low / (low - middle));
}

} // namespace

bool reaches_deep(const Cutter& cutter, const Blade& blade, const Tet& vertex, const Separation& parted) {
    const Section section = find_section(cutter, blade, vertex, parted);
    double whole = 0;
    double above = 0;
    for (std::size_t i = 2; i < section.count; ++i) {
        const SectionPoint& a = section.point[0];
        const SectionPoint& b = section.point[i - 1];
        const SectionPoint& c = section.point[i];
        const double area = length(cross(b.rest - a.rest, c.rest - a.rest));
        whole += area;
        above += area * share_above({a.height, b.height, c.height});
    }
    return above > 0 && above >= deep_enough * whole;
}

} // namespace resect
