// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "fem/law.hpp"
#include "sim/engine.hpp"

// How stiff copies are beyond the trusted range (docs/method.md, "Light copies"). Light copies between heavy
// ones are crushed and turned inside out, so their wall is raised as far as their nodes' mass bears it;
// copies that next to nothing bears keep only a part of their stiffness once they have left the range, since
// their nodes have no margin for a tangent that stiffens. Whole elements keep their law,
// wherever they have been: so nothing here touches a conforming mesh that is not cut.
namespace resect {

namespace {

// Found by trial on the matrix. Support is the least mass of a copy's free nodes in shares of a whole
// element.
constexpr double wall_share = 0.9;   // of a whole element's wall, that lighter copies have where it is borne
constexpr double wall_support = 0.2; // of the support, and no more
constexpr double least_stiffness =
    0.35; // of its own, that a weak copy keeps where nothing else bears its node
constexpr double stiffness_slope = 0.1; // more for each of its own weight that others add there

/// Least mass of the free nodes of a copy, in corner shares of its whole element; infinite where all are
/// held.
double find_support(const Engine& engine, Index copy) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    const std::size_t element = row(mesh.copy_element[row(copy)]);
    const double density = engine.tissue.materials[row(engine.model.region[element])].density;
    double least = std::numeric_limits<double>::infinity();
    for (const Index node : mesh.copy_node[row(copy)]) {
        if (mesh.node_held[row(node)] == 0) { least = std::min(least, mesh.node_mass[row(node)]); }
    }
    return least / (density * engine.model.rest[element].volume / 4);
}

/// Copies whose moduli are other than their material's, or may be.
bool is_light(const Engine& engine, Index copy) {
    return engine.weak[row(copy)] != 0 || simulation_mesh(*engine.cutter).copy_weight[row(copy)] < wall_share;
}

/// Sets the moduli of a copy by its nodes' masses and by its past.
void set_stiffness(Engine& engine, Index copy) {
    if (!is_light(engine, copy)) { return; }
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    const std::size_t element = row(mesh.copy_element[row(copy)]);
    const double weight = mesh.copy_weight[row(copy)];
    const double support = find_support(engine, copy);
    const Moduli m = moduli(engine.tissue.materials[row(engine.model.region[element])]);
    const double raised = std::max(1.0, std::min(wall_share, wall_support * support) / weight);
    const double borne = least_stiffness + stiffness_slope * (support / weight - 1);
    const double kept = engine.weak[row(copy)] != 0 ? std::min(1.0, borne) : 1;
    set_moduli(engine.elements, copy, {kept * m.mu, kept * m.bulk, raised * m.wall});
    if (engine.weak[row(copy)] != 0) { refresh_copy(engine.packing, engine.elements, copy); }
}

bool is_weakened(const Engine& engine, Index copy) {
    if (engine.weak[row(copy)] == 0) { return false; }
    const std::size_t element = row(simulation_mesh(*engine.cutter).copy_element[row(copy)]);
    const Moduli m = moduli(engine.tissue.materials[row(engine.model.region[element])]);
    return moduli_of(engine.elements, copy).mu < (1 - 1e-6) * m.mu;
}

} // namespace

void update_stiffness(Engine& engine, std::span<const Index> copies) {
    for (const Index copy : copies) {
        // In the range a wall stores nothing; what changes in copies that have left it is work done on them.
        const bool stores = engine.weak[row(copy)] != 0;
        const auto stored = [&] { return elastic_energy(engine.elements, engine.nodes.displacement, copy); };
        const double before = stores ? stored() : 0;
        set_stiffness(engine, copy);
        if (stores) { engine.work.internal += stored() - before; }
    }
}

void update_all_stiffness(Engine& engine) {
    for (Index copy = 0; copy < engine.elements.count; ++copy) {
        set_stiffness(engine, copy);
    }
}

void weaken_strained(Engine& engine) {
    for (const Part& part : engine.packing.parts) {
        for (const Index copy : part.left_range) {
            std::uint8_t& weak = engine.weak[row(copy)];
            if (weak != 0 || !is_light(engine, copy)) { continue; }
            weak = 1;
            set_stiffness(engine, copy);
        }
    }
}

void count_weakened(Engine& engine) {
    Index weakened = 0;
    for (Index copy = 0; copy < engine.elements.count; ++copy) {
        weakened += is_weakened(engine, copy) ? 1 : 0;
    }
    engine.strain.elements_weakened = weakened;
}

} // namespace resect
