// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "sim/check_setup.hpp"
#include "sim/engine.hpp"

namespace resect {

namespace {

constexpr Index blades_at_most = 64;
constexpr Index grasps_at_most = 64;
constexpr double farthest = 1e6; // m; beyond it a pose is a mistake

bool is_near(const Vec3& p) {
    return std::all_of(p.begin(), p.end(), [](double x) { return std::abs(x) <= farthest; });
}

Result<void> check_blade(Index blade) {
    if (0 <= blade && blade < blades_at_most) { return {}; }
    return Error{fmt::format("blade {}: blades are numbered 0 to {}", blade, blades_at_most - 1)};
}

std::vector<BladeWay>::iterator find_blade(Engine& engine, Index blade) {
    return std::find_if(engine.blades.begin(), engine.blades.end(),
                        [blade](const BladeWay& way) { return way.blade >= blade; });
}

bool is_there(const Engine& engine, std::vector<BladeWay>::iterator way, Index blade) {
    return way != engine.blades.end() && way->blade == blade;
}

Result<void> apply_one(Engine& engine, const MoveBlade& move) {
    if (Result<void> checked = check_blade(move.blade); !checked) { return checked; }
    if (Result<void> checked = check_edge(move.to); !checked) {
        return Error{fmt::format("blade {}: {}", move.blade, checked.error().message)};
    }
    const auto way = find_blade(engine, move.blade);
    if (is_there(engine, way, move.blade)) {
        way->poses.push_back(move.to);
        return {};
    }
    remember_stroke(engine);
    if (engine.blades.empty()) { engine.swept = engine.nodes.displacement; }
    engine.blades.insert(way, {.blade = move.blade, .at = move.to, .before = move.to});
    place_blade(*engine.cutter, move.blade, move.to, engine.nodes.displacement);
    return {};
}

Result<void> apply_one(Engine& engine, const LiftBlade& lift) {
    if (Result<void> checked = check_blade(lift.blade); !checked) { return checked; }
    const auto way = find_blade(engine, lift.blade);
    if (!is_there(engine, way, lift.blade)) {
        return Error{
            fmt::format("blade {}: is not there to be lifted; place it with MoveBlade first", lift.blade)};
    }
    if (lift.complete && !cut_through(engine, *way, engine.between)) {
        return Error{fmt::format("blade {}: has not moved, so there is no cut to complete; move it first",
                                 lift.blade)};
    }
    engine.blades.erase(way);
    lift_blade(*engine.cutter, lift.blade);
    return {};
}

bool is_held(const Engine& engine, Index reference) {
    const Rows<std::uint8_t>& held = simulation_mesh(*engine.cutter).node_held;
    const std::vector<Index>& nodes = engine.classes[row(reference)];
    return std::all_of(nodes.begin(), nodes.end(), [&](Index node) { return held[row(node)] != 0; });
}

Result<void> check_prescription(const Engine& engine, const Prescribe& told) {
    const Index count = static_cast<Index>(engine.model.elements.nodes.size());
    for (const Index node : told.nodes) {
        if (node < 0 || node >= count) {
            return Error{fmt::format("prescribe: node {} is not one of the body's {} nodes", node, count)};
        }
        if (engine.classes[row(node)].empty()) {
            return Error{fmt::format("prescribe: node {} belongs to no element; leave it out", node)};
        }
        if (is_held(engine, node)) {
            return Error{fmt::format("prescribe: node {} is fixed; leave it out", node)};
        }
    }
    for (const Index node : told.displacement.empty() ? std::span<const Index>() : told.nodes) {
        const std::vector<Index>& nodes = engine.classes[row(node)];
        if (std::any_of(nodes.begin(), nodes.end(), [&](Index at) { return is_grasped(engine, at); })) {
            return Error{fmt::format("prescribe: node {} is grasped; release it first", node)};
        }
    }
    if (!told.displacement.empty() && told.displacement.size() != told.nodes.size()) {
        return Error{
            fmt::format("prescribe: {} displacements for {} nodes; give one a node, or none to let go",
                        told.displacement.size(), told.nodes.size())};
    }
    for (std::size_t i = 0; i < told.displacement.size(); ++i) {
        if (!(length(told.displacement[i]) <= 1e3 * engine.model.size)) {
            return Error{fmt::format(
                "prescribe: node {}: a displacement must be finite and below a thousand body sizes",
                told.nodes[i])};
        }
    }
    return {};
}

Result<void> apply_one(Engine& engine, const Prescribe& told) {
    if (Result<void> checked = check_prescription(engine, told); !checked) { return checked; }
    for (std::size_t i = 0; i < told.nodes.size(); ++i) {
        if (told.displacement.empty()) {
            engine.prescribed.erase(told.nodes[i]);
        } else {
            engine.prescribed[told.nodes[i]] = told.displacement[i];
        }
    }
    update_all_conditions(engine);
    return {};
}

std::vector<GraspWay>::iterator find_grasp(Engine& engine, Index grasp) {
    return std::find_if(engine.grasps.begin(), engine.grasps.end(),
                        [grasp](const GraspWay& way) { return way.grasp >= grasp; });
}

bool is_there(const Engine& engine, std::vector<GraspWay>::iterator way, Index grasp) {
    return way != engine.grasps.end() && way->grasp == grasp;
}

Result<void> check_grasp(Index grasp, const Vec3& at) {
    if (grasp < 0 || grasp >= grasps_at_most) {
        return Error{fmt::format("grasp {}: grasps are numbered 0 to {}", grasp, grasps_at_most - 1)};
    }
    if (!is_near(at)) {
        return Error{fmt::format("grasp {}: the point must be finite and within {:g} m of the origin", grasp,
                                 farthest)};
    }
    return {};
}

Result<void> apply_one(Engine& engine, const Grasp& told) {
    if (Result<void> checked = check_grasp(told.grasp, told.at); !checked) { return checked; }
    const auto way = find_grasp(engine, told.grasp);
    if (is_there(engine, way, told.grasp)) {
        return Error{fmt::format("grasp {}: holds tissue already; release it first", told.grasp)};
    }
    std::vector<GraspedNode> nodes = find_grasped(engine, told.at, told.radius);
    if (nodes.empty()) {
        return Error{
            fmt::format("grasp {}: no free tissue within {:g} m of the point; grasp nearer to the body, "
                        "or by a larger radius",
                        told.grasp, told.radius)};
    }
    engine.grasps.insert(way, {told.grasp, told.at, told.at, told.radius, std::move(nodes)});
    update_all_conditions(engine);
    return {};
}

Result<void> apply_one(Engine& engine, const MoveGrasp& move) {
    if (Result<void> checked = check_grasp(move.grasp, move.to); !checked) { return checked; }
    const auto way = find_grasp(engine, move.grasp);
    if (!is_there(engine, way, move.grasp)) {
        return Error{fmt::format("grasp {}: holds nothing that could be moved; grasp first", move.grasp)};
    }
    way->to = move.to;
    return {};
}

Result<void> apply_one(Engine& engine, const Release& told) {
    const auto way = find_grasp(engine, told.grasp);
    if (!is_there(engine, way, told.grasp)) {
        return Error{fmt::format("grasp {}: holds nothing that could be released", told.grasp)};
    }
    engine.grasps.erase(way);
    update_all_conditions(engine);
    return {};
}

Result<void> apply_one(Engine& engine, const SetGravity& set) {
    if (Result<void> checked = check_gravity(set.gravity); !checked) { return checked; }
    engine.constants.gravity = to_float(set.gravity);
    return {};
}

Result<void> apply_one(Engine& engine, const SetMaterial& set) { return change_material(engine, set); }

Result<void> apply_one(Engine& engine, const Undo&) {
    if (undo_stroke(engine)) { return {}; }
    return Error{"undo: there is no stroke to undo"};
}

} // namespace

Result<void> check_edge(const Edge& edge) {
    if (!is_near(edge.heel) || !is_near(edge.tip)) {
        return Error{fmt::format("heel and tip must be finite and within {:g} m of the origin", farthest)};
    }
    if (!(length(edge.heel - edge.tip) > 0)) {
        return Error{"heel and tip are the same point; give it a length"};
    }
    return {};
}

Result<void> apply_command(Engine& engine, const Command& command) {
    const std::int64_t step = engine.step;
    Result<void> applied = std::visit([&](const auto& one) { return apply_one(engine, one); }, command);
    if (applied) { engine.record.push_back({step, command}); }
    return applied;
}

} // namespace resect
