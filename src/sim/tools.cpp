// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "sim/engine.hpp"

// Nodes that are told where to be: prescribed one by one, or by a tool that grasps the material in reach.
namespace resect {

namespace {

constexpr double rounding = 1e-6; // of the radius

/// Where the node's home is now, to within what an element deforms.
Vec3 place_of_home(const Engine& engine, std::size_t node) {
    return simulation_mesh(*engine.cutter).node_home[node] + to_double(engine.nodes.displacement[node]);
}

/// Within one step.
void move_node(Engine& engine, Index index, const Vec3& displacement) {
    const std::size_t node = row(index);
    const Vec3f target = to_float(displacement);
    const auto inverse_step = static_cast<float>(1 / engine.tissue.time_step);
    engine.nodes.velocity[node] = inverse_step * (target - engine.nodes.displacement[node]);
    engine.nodes.displacement[node] = target;
    place_node(engine.packing, engine.nodes, index);
}

void move_prescribed(Engine& engine) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    for (const auto& [reference, displacement] : engine.prescribed) {
        for (const Index node : engine.classes[row(reference)]) {
            const bool is_told = engine.nodes.inverse_mass[row(node)] == 0 && mesh.node_held[row(node)] == 0;
            if (is_told && !is_grasped(engine, node)) { move_node(engine, node, displacement); }
        }
    }
}

void move_grasps(Engine& engine) {
    const double share = 1 / static_cast<double>(engine.left);
    for (GraspWay& way : engine.grasps) {
        way.at = engine.left == 1 ? way.to : way.at + share * (way.to - way.at);
        for (const GraspedNode& grasped : way.nodes) {
            move_node(engine, grasped.node, way.at + grasped.offset);
        }
    }
}

} // namespace

bool is_grasped(const Engine& engine, Index node) {
    return std::any_of(engine.grasps.begin(), engine.grasps.end(), [&](const GraspWay& way) {
        return std::any_of(way.nodes.begin(), way.nodes.end(),
                           [&](const GraspedNode& grasped) { return grasped.node == node; });
    });
}

std::vector<GraspedNode> find_grasped(const Engine& engine, const Vec3& at, double radius) {
    std::vector<GraspedNode> grasped;
    for (std::size_t node = 0; node < engine.nodes.mass.size(); ++node) {
        const bool is_free = engine.nodes.inverse_mass[node] > 0;
        if (!is_free || !(length(place_of_home(engine, node) - at) <= radius)) { continue; }
        grasped.push_back({static_cast<Index>(node), to_double(engine.nodes.displacement[node]) - at});
    }
    return grasped;
}

void move_told_nodes(Engine& engine) {
    move_prescribed(engine);
    move_grasps(engine);
}

void update_grasps(Engine& engine, std::span<const Delta::NewNode> added) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    for (GraspWay& way : engine.grasps) {
        for (const Delta::NewNode& made : added) {
            const auto source =
                std::find_if(way.nodes.begin(), way.nodes.end(),
                             [&](const GraspedNode& grasped) { return grasped.node == made.source; });
            if (source != way.nodes.end()) { way.nodes.push_back({made.node, source->offset}); }
        }
        const double reach = (1 + rounding) * way.radius;
        std::erase_if(way.nodes, [&](const GraspedNode& grasped) {
            return mesh.node_held[row(grasped.node)] != 0 ||
                   length(place_of_home(engine, row(grasped.node)) - way.at) > reach;
        });
    }
}

} // namespace resect
