// SPDX-License-Identifier: Apache-2.0
#include "sim/engine.hpp"

// What TLED precomputes, for copies that a cut added: the paper's two methods, and one that begins again.
namespace resect {

namespace {

void set_rest_of(Engine& engine, const RestElement& rest, Index copy) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    const Model& model = engine.model;
    const std::size_t region = row(model.region[row(mesh.copy_element[row(copy)])]);
    const Moduli present = moduli_of(engine.elements, copy); // a matter of S and of the past (stiffness.cpp)
    set_copy(engine.elements, copy, rest, engine.tissue.materials[region],
             {.viscous_time = engine.tissue.viscous_time[region],
              .weight = mesh.copy_weight[row(copy)],
              .nodes = mesh.copy_node[row(copy)]});
    set_moduli(engine.elements, copy, present);
}

void compute_masses(Engine& engine) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    std::vector<double> mass(mesh.node_reference.size(), 0);
    for (std::size_t copy = 0; copy < mesh.copy_node.size(); ++copy) {
        const std::size_t element = row(mesh.copy_element[copy]);
        const double density = engine.tissue.materials[row(engine.model.region[element])].density;
        for (const Index node : mesh.copy_node[copy]) {
            mass[row(node)] += mesh.copy_weight[copy] * density * engine.model.rest[element].volume / 4;
        }
    }
    for (std::size_t node = 0; node < mass.size(); ++node) {
        engine.nodes.mass[node] = static_cast<float>(mass[node]);
    }
}

void compute_all(Engine& engine) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    engine.model.rest = build_rest(engine.model.elements);
    engine.tissue.rest_bound = least_step_bound(engine.model, engine.tissue.materials);
    for (std::size_t copy = 0; copy < mesh.copy_node.size(); ++copy) {
        set_rest_of(engine, engine.model.rest[row(mesh.copy_element[copy])], static_cast<Index>(copy));
    }
    compute_masses(engine);
}

} // namespace

void append_quantities(Engine& engine, std::span<const Delta::NewCopy> copies) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    for (const Delta::NewCopy& added : copies) {
        append_copy_of(engine.elements, added.parent);
        if (engine.model.quantities != Quantities::recompute) { continue; }
        const Tet& element = engine.model.elements.tets[row(mesh.copy_element[row(added.copy)])];
        set_rest_of(engine, build_rest_element(engine.model.elements, element), added.copy);
    }
    if (engine.model.quantities == Quantities::recompute_all && !copies.empty()) { compute_all(engine); }
}

} // namespace resect
