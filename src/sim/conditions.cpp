// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <numeric>

#include "sim/engine.hpp"

namespace resect {

namespace {

/// What is told of a reference node holds for the classes whose material is nearest to it: after a cut
/// through the node for each side, after a cut beside it for the side that has the node.
std::vector<Index> find_owners(const Engine& engine, Index reference) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    const Vec3& at = engine.model.elements.nodes[row(reference)];
    std::vector<Index> owners;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Index node : engine.classes[row(reference)]) {
        const double distance = length(mesh.node_home[row(node)] - at);
        if (distance < nearest) { owners.clear(); }
        nearest = std::min(nearest, distance);
        if (distance == nearest) { owners.push_back(node); }
    }
    return owners;
}

void apply_loads(Engine& engine) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    std::fill(engine.nodes.load.begin(), engine.nodes.load.end(), Vec3f{});
    for (const auto& [reference, force] : engine.model.loads) {
        const std::vector<Index> owners = find_owners(engine, reference);
        double mass = 0;
        for (const Index node : owners) {
            mass += mesh.node_mass[row(node)];
        }
        for (const Index node : owners) {
            engine.nodes.load[row(node)] += to_float((mesh.node_mass[row(node)] / mass) * force);
        }
    }
}

/// Owners may change with any cut, so nobody keeps what was told before.
void hold_what_is_told(Engine& engine) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    for (std::size_t node = 0; node < mesh.node_mass.size(); ++node) {
        engine.nodes.inverse_mass[node] =
            mesh.node_held[node] ? 0 : static_cast<float>(1 / mesh.node_mass[node]);
    }
    for (const auto& told : engine.prescribed) {
        for (const Index node : find_owners(engine, told.first)) {
            engine.nodes.inverse_mass[row(node)] = 0;
        }
    }
    for (const GraspWay& way : engine.grasps) {
        for (const GraspedNode& grasped : way.nodes) {
            engine.nodes.inverse_mass[row(grasped.node)] = 0;
        }
    }
}

} // namespace

void update_conditions(Engine& engine, std::span<const Index> touched) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    NodeArrays& nodes = engine.nodes;
    for (const Index touched_node : touched) {
        const std::size_t node = row(touched_node);
        nodes.mass[node] = static_cast<float>(mesh.node_mass[node]);
        nodes.inverse_mass[node] = mesh.node_held[node] ? 0 : static_cast<float>(1 / mesh.node_mass[node]);
        if (mesh.node_held[node]) { nodes.velocity[node] = {}; }
        place_node(engine.packing, nodes, touched_node);
    }
    if (!engine.model.loads.empty()) { apply_loads(engine); }
    engine.fixed.resize(nodes.mass.size());
    const auto note_fixed = [&](std::size_t node) {
        engine.fixed[node] = nodes.inverse_mass[node] == 0 ? 1 : 0;
    };
    if (!engine.prescribed.empty() || !engine.grasps.empty()) {
        hold_what_is_told(engine);
        for (std::size_t node = 0; node < engine.fixed.size(); ++node) {
            note_fixed(node);
        }
        return;
    }
    for (const Index node : touched) {
        note_fixed(row(node));
    }
}

void update_all_conditions(Engine& engine) {
    std::vector<Index> all(engine.nodes.mass.size());
    std::iota(all.begin(), all.end(), 0);
    update_conditions(engine, all);
}

} // namespace resect
