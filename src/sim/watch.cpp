// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "sim/engine.hpp"

namespace resect {

namespace {

constexpr Index copies_a_chunk = 512;

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

/// `look` is called for ranges of copies.
template <class Look>
StrainCheck over_all_copies(Engine& engine, Look look) {
    const Index chunks = chunk_count(copies_a_chunk, engine.elements.count);
    engine.strain_parts.resize(static_cast<std::size_t>(chunks));
    engine.workers.run(chunks, [&](Index chunk) {
        const auto [begin, end] = chunk_range(chunk, copies_a_chunk, engine.elements.count);
        engine.strain_parts[row(chunk)] = look({begin, end});
    });
    StrainCheck all;
    for (const StrainCheck& part : engine.strain_parts) {
        all = merge(all, part);
    }
    return all;
}

void take_note(Strain& strain, const StrainCheck& now) {
    strain.stretch_min = std::min(strain.stretch_min, now.stretch_min);
    strain.stretch_max = std::max(strain.stretch_max, now.stretch_max);
    strain.elements_beyond_range = std::max(strain.elements_beyond_range, now.beyond_range);
    strain.elements_inverted = now.inverted;
}

} // namespace

void check_strain_now(Engine& engine) {
    const StrainCheck now = over_all_copies(engine, [&](Range copies) {
        return check_strain(engine.elements, engine.nodes, engine.copy_density, copies);
    });
    count_weakened(engine);
    take_note(engine.strain, now);
    engine.live_bound = now.live_bound;
}

void check_strain_if_due(Engine& engine) {
    if (engine.step % check_interval != 0) { return; }
    if (engine.step % bound_interval == 0) { return check_strain_now(engine); }
    const StrainCheck known = {.stretch_min = engine.strain.stretch_min,
                               .stretch_max = engine.strain.stretch_max};
    const StrainCheck now = over_all_copies(
        engine, [&](Range copies) { return screen_strain(engine.elements, engine.nodes, known, copies); });
    count_weakened(engine);
    take_note(engine.strain, now);
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
        engine.step + 1, element, least, speed, engine.tissue.time_step, engine.live_bound);
    return element;
}

} // namespace resect
