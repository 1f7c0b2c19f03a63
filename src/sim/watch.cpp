// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "sim/engine.hpp"

namespace resect {

namespace {

constexpr Index screened_a_chunk = 512, checked_a_chunk = 32; // copies

/// The node that moves fastest in the step that was refused; one whose motion is no number before all others.
Index find_fastest_node(const NodeArrays& nodes) {
    Index fastest = 0;
    float most = -1;
    for (std::size_t node = 0; node < nodes.next_velocity.size(); ++node) {
        const float speed = dot(nodes.next_velocity[node], nodes.next_velocity[node]);
        if (!std::isfinite(speed)) { return static_cast<Index>(node); }
        if (speed > most && nodes.inverse_mass[node] > 0) {
            most = speed;
            fastest = static_cast<Index>(node);
        }
    }
    return fastest;
}

double present_volume(const Engine& engine, Index copy) {
    Vec3 at[4];
    const Tet tet = corners(engine.elements, copy);
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const std::size_t node = row(tet[corner]);
        at[corner] = to_double(engine.nodes.rest[node]) + to_double(engine.nodes.displacement[node]);
    }
    return signed_volume(at[0], at[1], at[2], at[3]);
}

/// `look` is called for parts of the range.
template <class Look>
StrainCheck over_copies(Engine& engine, Range copies, Index copies_a_chunk, Look look) {
    const Index count = copies.end - copies.begin, chunks = chunk_count(copies_a_chunk, count);
    engine.strain_parts.resize(static_cast<std::size_t>(chunks));
    engine.workers.run(chunks, [&](Index chunk) {
        const auto [begin, end] = chunk_range(chunk, copies_a_chunk, count);
        engine.strain_parts[row(chunk)] = look({copies.begin + begin, copies.begin + end});
    });
    StrainCheck all;
    for (const StrainCheck& part : engine.strain_parts) {
        all = merge(all, part);
    }
    return all;
}

StrainCheck check_copies(Engine& engine, Range copies) {
    return over_copies(engine, copies, checked_a_chunk, [&](Range part) {
        return check_strain(engine.elements, engine.nodes, engine.copy_density, part);
    });
}

/// Of the copies whose turn it is by the number of the step.
void look_at_bounds(Engine& engine) {
    const std::int64_t share = engine.step / check_interval % bound_shares, count = engine.elements.count;
    const auto begin_of = [&](std::int64_t n) { return static_cast<Index>(count * n / bound_shares); };
    auto& [known, round] = engine.live_bound;
    round = std::min(round, check_copies(engine, {begin_of(share), begin_of(share + 1)}).live_bound);
    known = std::min(known, round);
    if (share == bound_shares - 1) { engine.live_bound = {.known = round}; }
}

void take_note(Strain& strain, const StrainCheck& now) {
    strain.stretch_min = std::min(strain.stretch_min, now.stretch_min);
    strain.stretch_max = std::max(strain.stretch_max, now.stretch_max);
    strain.elements_beyond_range = std::max(strain.elements_beyond_range, now.beyond_range);
    strain.elements_inverted = now.inverted;
}

} // namespace

void check_strain_now(Engine& engine) {
    const StrainCheck now = check_copies(engine, {0, engine.elements.count});
    count_weakened(engine);
    take_note(engine.strain, now);
    engine.live_bound = {.known = now.live_bound};
}

void check_strain_if_due(Engine& engine) {
    if (engine.step % check_interval != 0) { return; }
    const StrainCheck known = {.stretch_min = engine.strain.stretch_min,
                               .stretch_max = engine.strain.stretch_max};
    const StrainCheck now =
        over_copies(engine, {0, engine.elements.count}, screened_a_chunk, [&](Range copies) {
            return screen_strain(engine.elements, engine.nodes, known, copies);
        });
    count_weakened(engine);
    take_note(engine.strain, now);
    look_at_bounds(engine);
}

Index find_diverged_element(const Engine& engine, std::string& reason) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    const Index node = find_fastest_node(engine.nodes);
    Index worst = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Index copy = 0; copy < engine.elements.count; ++copy) {
        const Tet tet = corners(engine.elements, copy);
        if (std::find(tet.begin(), tet.end(), node) == tet.end()) { continue; }
        const std::size_t element = row(mesh.copy_element[row(copy)]);
        const double J = present_volume(engine, copy) / engine.model.rest[element].volume;
        if (worst < 0 || J < least) {
            worst = copy;
            least = J;
        }
    }
    const Index element = worst < 0 ? -1 : mesh.copy_element[row(worst)];
    const double speed = static_cast<double>(length(engine.nodes.next_velocity[row(node)]));
    reason = fmt::format(
        "diverged in step {}: a node of element {} (volume ratio {:.3g}) would move at {:.3g} m/s; "
        "lower the time step (used {:.3g} s, live bound {:.3g} s), the load or the damping",
        engine.step + 1, element, least, speed, engine.tissue.time_step, engine.live_bound.known);
    return element;
}

} // namespace resect
