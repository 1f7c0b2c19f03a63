// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/clock.hpp"
#include "sim/engine.hpp"

namespace resect {

namespace {

constexpr double sweep_reach = 0.25;     // of a mean element that a blade moves in one sweep
constexpr double sweeps_at_most = 20000; // of one move

Edge between(const Edge& a, const Edge& b, double t) {
    return {a.heel + t * (b.heel - a.heel), a.tip + t * (b.tip - a.tip)};
}

/// New rows start with the motion of the node that they come from, now and at the start of the sweep.
void append_nodes(Engine& engine, std::span<const Delta::NewNode> added) {
    NodeArrays& nodes = engine.nodes;
    const auto repeat = [](std::vector<Vec3f>& array, Index source) {
        const Vec3f value = array[row(source)];
        array.push_back(value);
    };
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    for (const Delta::NewNode& node : added) {
        engine.classes[row(mesh.node_reference[row(node.node)])].push_back(node.node);
        repeat(nodes.rest, node.source);
        repeat(nodes.displacement, node.source);
        repeat(nodes.velocity, node.source);
        repeat(engine.swept, node.source);
        nodes.next_displacement.emplace_back();
        nodes.next_velocity.emplace_back();
        nodes.load.emplace_back();
        nodes.mass.push_back(0);
        nodes.inverse_mass.push_back(0);
    }
    update_grasps(engine, added);
}

/// Copies that a cut made, moved to other nodes or weighed anew, in the order of their rows.
void patch_packing(Engine& engine) {
    const Delta& delta = engine.delta;
    for (const Delta::NewCopy& added : delta.copies) {
        seat_new_copy(engine.packing, engine.elements, engine.nodes, added.copy, added.parent);
    }
    const Index first_new = delta.copies.empty() ? engine.elements.count : delta.copies.front().copy;
    engine.moved.clear();
    for (const Delta::Corner& corner : delta.corners) {
        if (corner.copy < first_new) { engine.moved.push_back(corner.copy); }
    }
    std::sort(engine.moved.begin(), engine.moved.end());
    engine.moved.erase(std::unique(engine.moved.begin(), engine.moved.end()), engine.moved.end());
    for (const Index copy : engine.moved) {
        reseat_copy(engine.packing, engine.elements, engine.nodes, copy);
    }
    for (const Index copy : delta.weighed) {
        refresh_copy(engine.packing, engine.elements, copy);
    }
}

/// Follows a change of S in the arrays that the step works on.
void apply_delta(Engine& engine, CutReport& report) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    const Delta& delta = engine.delta;
    Stopwatch watch;
    append_nodes(engine, delta.nodes);
    for (const Delta::NewCopy& copy : delta.copies) {
        const float density = engine.copy_density[row(copy.parent)];
        engine.copy_density.push_back(density);
        const std::uint8_t weak = engine.weak[row(copy.parent)];
        engine.weak.push_back(weak);
    }
    report.us.derive += watch.lap();
    append_quantities(engine, delta.copies);
    report.us.quantities += watch.lap();
    for (const Delta::Corner& corner : delta.corners) {
        set_corner(engine.elements, corner.copy, corner.corner, corner.node);
    }
    for (const Index copy : delta.weighed) {
        const Index element = mesh.copy_element[row(copy)];
        set_weight(engine.elements, copy, mesh.copy_weight[row(copy)],
                   engine.model.rest[row(element)].volume);
    }
    patch_packing(engine);
    update_stiffness(engine, delta.touched_copies);
    update_conditions(engine, delta.touched_nodes);
    report.us.derive += watch.lap();
}

/// Sweeps a blade to `to`. The first sweep since the tissue moved takes that motion in, later ones see it
/// still.
void sweep_one(Engine& engine, Index blade, const Edge& to, bool first, CutReport& report) {
    const std::vector<Vec3f>& before = first ? engine.swept : engine.nodes.displacement;
    sweep_blade(*engine.cutter, blade, to, before, engine.nodes.displacement, engine.delta, report);
    if (engine.delta.weighed.empty() && engine.delta.touched_nodes.empty()) { return; }
    // With plain copies a cut adds energy out of nothing; the accounts of work and motion take it over.
    const bool adds_energy = engine.model.weights == Weights::copy;
    const double elastic = adds_energy ? elastic_energy(engine.elements, engine.nodes.displacement) : 0;
    apply_delta(engine, report);
    if (adds_energy) {
        engine.work.internal += elastic_energy(engine.elements, engine.nodes.displacement) - elastic;
    }
}

/// Sweeps a blade from one pose to the next in moves that are small beside an element, as crossings want
/// them.
void sweep_finely(Engine& engine, Index blade, const std::array<Edge, 2>& move, bool first,
                  CutReport& report) {
    const auto& [from, to] = move;
    const double travel = std::max(length(to.heel - from.heel), length(to.tip - from.tip));
    const double wanted = std::ceil(travel / (sweep_reach * engine.model.element_size));
    const int sweeps = static_cast<int>(std::clamp(wanted, 1.0, sweeps_at_most));
    for (int sweep = 1; sweep < sweeps; ++sweep) {
        sweep_one(engine, blade, between(from, to, static_cast<double>(sweep) / sweeps), first && sweep == 1,
                  report);
    }
    sweep_one(engine, blade, to, first && sweeps == 1, report);
}

/// Takes the share of the way that falls to one of `left` steps.
void follow(Engine& engine, BladeWay& way, std::int64_t left, CutReport& report) {
    bool first = true;
    const auto sweep_to = [&](const Edge& pose) {
        const Edge from = std::exchange(way.at, pose);
        if (from.heel != pose.heel || from.tip != pose.tip) { way.before = from; }
        sweep_finely(engine, way.blade, {from, pose}, std::exchange(first, false), report);
    };
    double share = (static_cast<double>(way.poses.size()) - way.begun) / static_cast<double>(left);
    while (!way.poses.empty() && (left == 1 || way.begun + share >= 1)) {
        share -= 1 - way.begun;
        way.begun = 0;
        sweep_to(way.poses.front());
        way.poses.erase(way.poses.begin());
    }
    if (!way.poses.empty() && share > 0) {
        sweep_to(between(way.at, way.poses.front(), share / (1 - way.begun)));
        way.begun += share;
    }
    if (first) { sweep_to(way.at); } // the tissue may move onto a blade at rest
}

} // namespace

void sweep_blades(Engine& engine, std::int64_t left, CutReport& report) {
    if (engine.blades.empty()) { return; }
    for (BladeWay& way : engine.blades) {
        follow(engine, way, left, report);
    }
    engine.swept = engine.nodes.displacement;
}

bool cut_through(Engine& engine, const BladeWay& way, CutReport& report) {
    const Vec3 along = direction(way.at.heel - way.at.tip);
    const Vec3 moved = (way.at.heel + way.at.tip) - (way.before.heel + way.before.tip);
    const Vec3 across = moved - dot(moved, along) * along;
    if (!(length(across) > 1e-9 * engine.model.size)) { return false; }
    const Vec3 longer = engine.model.size * along;
    const Vec3 onward = 2 * engine.model.size * direction(across);
    const Edge from = {way.at.heel + longer, way.at.tip - longer};
    sweep_one(engine, way.blade, from, true, report);
    sweep_finely(engine, way.blade, {from, Edge{from.heel + onward, from.tip + onward}}, false, report);
    return true;
}

void sweep_still(Engine& engine, Index blade, const Edge& from, const Edge& to, CutReport& report) {
    sweep_finely(engine, blade, {from, to}, false, report);
}

} // namespace resect
