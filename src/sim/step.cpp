// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/engine.hpp"

namespace resect {

namespace {

// Chunks are a matter of the mesh, never of the threads, so that sums and bits are the same for any number of
// them.
constexpr Index blocks_a_chunk = 64;
constexpr Index nodes_a_chunk = 1024;

Index node_count(const Engine& engine) { return static_cast<Index>(engine.nodes.mass.size()); }

StepSums update_nodes(Engine& engine) {
    const Index count = node_count(engine), chunks = chunk_count(nodes_a_chunk, count);
    engine.sums.resize(static_cast<std::size_t>(chunks));
    engine.workers.run(chunks, [&](Index chunk) {
        const auto [begin, end] = chunk_range(chunk, nodes_a_chunk, count);
        engine.sums[row(chunk)] = node_update(engine.elements, engine.nodes, engine.constants, {begin, end});
    });
    StepSums total;
    for (const StepSums& part : engine.sums) {
        total.internal_work += part.internal_work;
        total.damping_work += part.damping_work;
        total.kinetic += part.kinetic;
        // Written so that a speed that is not a number stays one.
        if (!(part.speed_squared <= total.speed_squared)) { total.speed_squared = part.speed_squared; }
    }
    return total;
}

/// Prescribed nodes arrive where they are told within one step and stay.
void move_prescribed(Engine& engine) {
    if (engine.prescribed.empty()) { return; }
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    const float inverse_step = static_cast<float>(1 / engine.time_step);
    for (std::size_t node = 0; node < mesh.node_reference.size(); ++node) {
        const auto told = engine.prescribed.find(mesh.node_reference[node]);
        if (told == engine.prescribed.end() || engine.nodes.inverse_mass[node] != 0 || mesh.node_held[node]) {
            continue;
        }
        const Vec3f target = to_float(told->second);
        engine.nodes.velocity[node] = inverse_step * (target - engine.nodes.displacement[node]);
        engine.nodes.displacement[node] = target;
    }
}

} // namespace

void compute_forces(Engine& engine) {
    const Index blocks = static_cast<Index>(engine.elements.blocks.size());
    engine.workers.run(chunk_count(blocks_a_chunk, blocks), [&](Index chunk) {
        const auto [begin, end] = chunk_range(chunk, blocks_a_chunk, blocks);
        element_forces(engine.elements, engine.nodes, {begin, end});
    });
}

bool step_motion(Engine& engine) {
    move_prescribed(engine);
    compute_forces(engine);
    const StepSums sums = update_nodes(engine);
    // A body that crosses its own size in a step has blown up, and is stopped while its numbers are still
    // finite.
    const double speed = std::sqrt(static_cast<double>(sums.speed_squared));
    if (!(speed * engine.time_step <= engine.model.size)) { return false; }
    std::swap(engine.nodes.displacement, engine.nodes.next_displacement);
    std::swap(engine.nodes.velocity, engine.nodes.next_velocity);
    engine.work.internal += sums.internal_work;
    engine.work.damping += sums.damping_work;
    engine.kinetic = sums.kinetic;
    ++engine.step;
    return true;
}

} // namespace resect
