// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace resect {

/// A point of the plane across the blade, on the integer grid.
struct GridPoint {
    std::int64_t x = 0, y = 0;
};

inline constexpr double grid_per_unit = 1 << 28;
/// Products of two coordinates and their differences then fit 63 bits.
inline constexpr double grid_reach = 4; // units

/// False also for what is not finite.
inline bool is_on_grid(double x, double y) { return std::abs(x) < grid_reach && std::abs(y) < grid_reach; }
inline GridPoint quantise(double x, double y) {
    return {std::llround(grid_per_unit * x), std::llround(grid_per_unit * y)};
}

constexpr std::int64_t cross(const GridPoint& a, const GridPoint& b) { return a.x * b.y - a.y * b.x; }

/// Sign of the turn origin, a, b, the origin being shifted by (e1, e2) with 1 >> e1 >> e2 > 0: exact, and
/// never 0 for two points that differ.
constexpr int turn(const GridPoint& a, const GridPoint& b) {
    const std::int64_t area = cross(a, b);
    if (area != 0) { return area > 0 ? 1 : -1; }
    if (a.y != b.y) { return a.y > b.y ? 1 : -1; }
    if (a.x != b.x) { return b.x > a.x ? 1 : -1; }
    return 0;
}

constexpr bool holds_origin(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
    const int side = turn(a, b);
    return side != 0 && turn(b, c) == side && turn(c, a) == side;
}

} // namespace resect
