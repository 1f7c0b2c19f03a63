// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.hpp"
#include "fem/step.hpp"

namespace resect {
namespace {

/// Sum over the corners that a node has, in ascending slot order, N.
Vec3f internal_force(const Elements& elements, Index node) {
    Vec3f sum = {};
    for (Index slot = elements.first_slot[row(node)]; slot >= 0; slot = elements.next_slot[row(slot)]) {
        const Index copy = slot / 4;
        const auto& force = elements.forces[row(copy / lanes)].force[slot % 4];
        const Index lane = copy % lanes;
        sum += Vec3f{force[0][lane], force[1][lane], force[2][lane]};
    }
    return sum;
}

/// Central differences in leapfrog form: M a + alpha M v = R - f with v at the half steps gives
/// v+ = c1 v- + c2 ((load - f) / m + g) and u+ = u + dt v+, where c2 = dt / (1 + alpha dt / 2) and
/// c1 = (1 - alpha dt / 2) / (1 + alpha dt / 2) = 1 - alpha c2; the last form rounds least.
/// A node without inverse mass goes on as it is: its velocity and displacement are the caller's.
void move(NodeArrays& nodes, const StepConstants& constants, std::size_t node, const Vec3f& internal) {
    const float dt = constants.time_step;
    const float c2 = dt / (1 + constants.damping * dt / 2);
    const float inverse_mass = nodes.inverse_mass[node];
    Vec3f velocity = nodes.velocity[node];
    Vec3f displacement = nodes.displacement[node];
    if (inverse_mass > 0) {
        const Vec3f undamped = inverse_mass * (nodes.load[node] - internal) + constants.gravity;
        velocity += c2 * (undamped - constants.damping * velocity);
        displacement += dt * velocity;
    }
    nodes.next_velocity[node] = velocity;
    nodes.next_displacement[node] = displacement;
}

void add_energies(StepSums& sums, const NodeArrays& nodes, const StepConstants& constants, Index n,
                  const Vec3f& internal) {
    const std::size_t node = row(n);
    const double mass = double(nodes.mass[node]);
    const double dt = double(constants.time_step);
    const Vec3 after = to_double(nodes.next_velocity[node]);
    const Vec3 mean = 0.5 * (to_double(nodes.velocity[node]) + after);
    sums.kinetic += 0.5 * mass * dot(after, after);
    sums.internal_work += dt * dot(to_double(internal), mean);
    if (nodes.inverse_mass[node] > 0) {
        sums.damping_work += dt * double(constants.damping) * mass * dot(mean, mean);
    }
}

} // namespace

Vec3 applied_force(const NodeArrays& nodes, const StepConstants& constants, Index node) {
    return to_double(nodes.load[row(node)]) + double(nodes.mass[row(node)]) * to_double(constants.gravity);
}

double kinetic_energy(const NodeArrays& nodes) {
    double energy = 0;
    for (std::size_t node = 0; node < nodes.mass.size(); ++node) {
        const Vec3 v = to_double(nodes.velocity[node]);
        energy += static_cast<double>(nodes.mass[node]) / 2 * dot(v, v);
    }
    return energy;
}

StepSums node_update(const Elements& elements, NodeArrays& nodes, const StepConstants& constants,
                     Range range) {
    StepSums sums;
    bool finite = true;
    for (Index n = range.begin; n < range.end; ++n) {
        const std::size_t node = row(n);
        const Vec3f internal = internal_force(elements, n);
        move(nodes, constants, node, internal);
        add_energies(sums, nodes, constants, n, internal);
        const float speed_squared = dot(nodes.next_velocity[node], nodes.next_velocity[node]);
        if (nodes.inverse_mass[node] > 0) {
            sums.speed_squared = std::max(sums.speed_squared, speed_squared);
        }
        finite = finite && std::isfinite(speed_squared) && is_finite(nodes.next_displacement[node]) &&
                 is_finite(internal);
    }
    if (!finite) { sums.speed_squared = std::numeric_limits<float>::quiet_NaN(); }
    return sums;
}

Vec3 net_force(const Elements& elements, const NodeArrays& nodes, const StepConstants& constants,
               Index node) {
    return applied_force(nodes, constants, node) - to_double(internal_force(elements, node));
}

} // namespace resect
