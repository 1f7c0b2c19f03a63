// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/engine.hpp"

namespace resect {

namespace {

// Chunks are a matter of the mesh, never of the threads, so that sums and bits are the same for any number of
// them.
constexpr Index nodes_a_chunk = 1024;

/// One part after the other, by the number of the step and never by the clock: bits do not depend on speed.
void repack_one_part(Engine& engine) {
    const auto parts = static_cast<std::int64_t>(engine.packing.parts.size());
    repack(engine.packing, engine.elements, engine.nodes, static_cast<Index>(engine.step % parts));
}

} // namespace

void compute_forces(Engine& engine) {
    engine.workers.run(static_cast<Index>(engine.packing.parts.size()), [&](Index part) {
        element_forces(engine.elements, engine.nodes, engine.packing, part);
    });
}

StepSums update_nodes(Engine& engine) {
    const Index count = static_cast<Index>(engine.nodes.mass.size());
    const Index chunks = chunk_count(nodes_a_chunk, count);
    engine.sums.resize(static_cast<std::size_t>(chunks));
    engine.workers.run(chunks, [&](Index chunk) {
        const auto [begin, end] = chunk_range(chunk, nodes_a_chunk, count);
        engine.sums[row(chunk)] = node_update(engine.packing, engine.nodes, engine.constants, {begin, end});
    });
    StepSums total;
    for (const StepSums& part : engine.sums) {
        total = total + part;
    }
    return total;
}

bool step_motion(Engine& engine) {
    move_told_nodes(engine);
    compute_forces(engine);
    const StepSums sums = update_nodes(engine);
    // A body that crosses its own size in a step has blown up, and is stopped while its numbers are still
    // finite.
    const double speed = std::sqrt(static_cast<double>(sums.speed_squared));
    if (!(speed * engine.tissue.time_step <= engine.model.size)) {
        place_all_nodes(engine.packing, engine.nodes);
        return false;
    }
    std::swap(engine.nodes.displacement, engine.nodes.next_displacement);
    std::swap(engine.nodes.velocity, engine.nodes.next_velocity);
    engine.work.internal += sums.internal_work;
    engine.work.damping += sums.damping_work;
    ++engine.step;
    weaken_strained(engine);
    repack_one_part(engine);
    return true;
}

} // namespace resect
