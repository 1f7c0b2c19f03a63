// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "resect/resect.hpp"

#include "base/index.hpp"
#include "base/vec.hpp"

namespace resect {

/// A Kuhn block of `n` cells an edge and 0.1 m, its left side held, without gravity or damping.
inline Setup held_block(Index n, double young = 2e4) {
    Setup setup{.body = must(make_block({0.1, 0.1, 0.1}, {n, n, n})),
                .materials = {{.young = young}},
                .fixed = {{.box = {.lo = {0, -1, -1}, .hi = {0, 1, 1}}}},
                .gravity = {},
                .threads = 1};
    return setup;
}

inline Setup free_block(Index n, double young = 2e4) {
    Setup setup = held_block(n, young);
    setup.fixed.clear();
    return setup;
}

/// A horizontal edge along y, right across a block of 0.1 m, sweeping down through x = `at`.
inline Edge edge_above(double at, double z) { return {{at, 0.15, z}, {at, -0.05, z}}; }

/// The line with which a command is refused; empty if it is not.
inline std::string refusal(Simulation& simulation, const Command& command) {
    const Result<void> applied = simulation.apply(command);
    return applied ? "" : applied.error().message;
}

inline Vec3 momentum(const Simulation& simulation) {
    Vec3 sum = {};
    const Nodes nodes = simulation.nodes();
    for (std::size_t node = 0; node < nodes.mass.size(); ++node) {
        sum += double(nodes.mass[node]) * to_double(nodes.velocity[node]);
    }
    return sum;
}

inline Vec3 angular_momentum(const Simulation& simulation) {
    Vec3 sum = {};
    const Nodes nodes = simulation.nodes();
    for (std::size_t node = 0; node < nodes.mass.size(); ++node) {
        const Vec3 at = to_double(nodes.rest[node]) + to_double(nodes.displacement[node]);
        sum += double(nodes.mass[node]) * cross(at, to_double(nodes.velocity[node]));
    }
    return sum;
}

inline double kinetic_energy(const Simulation& simulation) {
    double sum = 0;
    const Nodes nodes = simulation.nodes();
    for (std::size_t node = 0; node < nodes.mass.size(); ++node) {
        const Vec3 v = to_double(nodes.velocity[node]);
        sum += double(nodes.mass[node]) / 2 * dot(v, v);
    }
    return sum;
}

inline double total_mass(const Simulation& simulation) {
    double sum = 0;
    for (const float mass : simulation.nodes().mass) {
        sum += double(mass);
    }
    return sum;
}

inline double largest_displacement(const Simulation& simulation) {
    double largest = 0;
    for (const Vec3f& u : simulation.nodes().displacement) {
        largest = std::max(largest, length(to_double(u)));
    }
    return largest;
}

} // namespace resect
