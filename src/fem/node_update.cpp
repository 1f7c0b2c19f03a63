// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "fem/choose_kernels.hpp"
#include "fem/step.hpp"

namespace resect {
namespace {

float* flat(std::vector<Vec3f>& rows) { return rows.data()->data(); }

/// The positions of node_update, where parts differ in viscous time.
void place_next(Packing& packing, const NodeArrays& nodes, Range range) {
    for (Index node = range.begin; node < range.end; ++node) {
        place_at(packing, node, nodes.next_displacement[row(node)], nodes.next_velocity[row(node)]);
    }
}

} // namespace

StepSums operator+(const StepSums& a, const StepSums& b) {
    // Written so that a speed that is not a number stays one.
    return {a.internal_work + b.internal_work, a.damping_work + b.damping_work,
            std::isnan(a.speed_squared) || b.speed_squared <= a.speed_squared ? a.speed_squared
                                                                              : b.speed_squared};
}

Vec3f internal_force(const Packing& packing, Index node) {
    Vec3f sum = {};
    for (Index slot = packing.first_slot[row(node)]; slot >= 0; slot = packing.next_slot[row(slot)]) {
        const Row& force = packing.force[row(slot)];
        sum += Vec3f{force.x, force.y, force.z};
    }
    return sum;
}

Vec3 applied_force(const NodeArrays& nodes, const StepConstants& constants, Index node) {
    return to_double(nodes.load[row(node)]) + double(nodes.mass[row(node)]) * to_double(constants.gravity);
}

Vec3 net_force(const Packing& packing, const NodeArrays& nodes, const StepConstants& constants, Index node) {
    return applied_force(nodes, constants, node) - to_double(internal_force(packing, node));
}

double kinetic_energy(const NodeArrays& nodes) {
    double energy = 0;
    for (std::size_t node = 0; node < nodes.mass.size(); ++node) {
        const Vec3 v = to_double(nodes.velocity[node]);
        energy += static_cast<double>(nodes.mass[node]) / 2 * dot(v, v);
    }
    return energy;
}

StepSums node_update(Packing& packing, NodeArrays& nodes, const StepConstants& constants, Range range) {
    RESECT_ASSERT(range.begin % 8 == 0);
    const NodeSums sums =
        kernels().move_nodes({.begin = range.begin,
                              .end = range.end,
                              .first_slot = packing.first_slot.data(),
                              .next_slot = packing.next_slot.data(),
                              .force = packing.force.data(),
                              .rest = packing.rest.data(),
                              .position = packing.position.data(),
                              .displacement = flat(nodes.displacement),
                              .velocity = flat(nodes.velocity),
                              .load = flat(nodes.load),
                              .mass = nodes.mass.data(),
                              .inverse_mass = nodes.inverse_mass.data(),
                              .next_displacement = flat(nodes.next_displacement),
                              .next_velocity = flat(nodes.next_velocity),
                              .time_step = constants.time_step,
                              .damping = constants.damping,
                              .viscous_time = packing.parts.front().viscous_time,
                              .quanta_a_metre = packing.quanta_a_metre,
                              .gravity = {constants.gravity[0], constants.gravity[1], constants.gravity[2]}});
    if (!packing.one_viscous_time) { place_next(packing, nodes, range); }
    return {double(sums.internal_work), double(sums.damping_work), sums.speed_squared};
}

} // namespace resect
