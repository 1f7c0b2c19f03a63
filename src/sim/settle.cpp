// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "sim/engine.hpp"

namespace resect {

namespace {

constexpr int calm_steps = 50;      // in a row below the residual
constexpr int averaged_steps = 500; // of the running mean of forces
constexpr double past_peak = 0.8;   // of the peak: rounding alone moves the kinetic energy up and down
constexpr double easing_time = 2;   // s, at most a third of the time given

/// Nodes that count: free ones of pieces that something holds, be it fixed or prescribed. Other pieces fall
/// for ever.
std::vector<Index> find_supported_nodes(Engine& engine) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    const std::span<const Index> piece_of = piece_of_copy(*engine.cutter);
    const auto is_free = [&](Index node) { return engine.nodes.inverse_mass[row(node)] > 0; };
    std::set<Index> held_pieces;
    for (std::size_t copy = 0; copy < mesh.copy_node.size(); ++copy) {
        const Tet& nodes = mesh.copy_node[copy];
        if (!std::all_of(nodes.begin(), nodes.end(), is_free)) { held_pieces.insert(piece_of[copy]); }
    }
    std::vector<std::uint8_t> supported(mesh.node_reference.size(), 0);
    for (std::size_t copy = 0; copy < mesh.copy_node.size(); ++copy) {
        if (!held_pieces.contains(piece_of[copy])) { continue; }
        for (const Index node : mesh.copy_node[copy]) {
            supported[row(node)] = is_free(node) ? 1 : 0;
        }
    }
    std::vector<Index> nodes;
    for (std::size_t node = 0; node < supported.size(); ++node) {
        if (supported[node] != 0) { nodes.push_back(static_cast<Index>(node)); }
    }
    return nodes;
}

/// The load that is out of balance at the start is taken on gradually, so that the body does not swing out
/// beyond where it comes to rest; from any start, not only from rest.
class Easing {
public:
    explicit Easing(Engine& engine) : load_(engine.nodes.load), missing_(load_.size()) {
        compute_forces(engine);
        for (std::size_t node = 0; node < missing_.size(); ++node) {
            missing_[node] =
                to_float(net_force(engine.packing, engine.nodes, engine.constants, static_cast<Index>(node)));
        }
    }
    /// From share 0, where all is in balance, to share 1, where the load is the body's own.
    void ease(Engine& engine, double share) const {
        const auto left = static_cast<float>(1 - share * share * (3 - 2 * share));
        for (std::size_t node = 0; node < load_.size(); ++node) {
            engine.nodes.load[node] = share < 1 ? load_[node] - left * missing_[node] : load_[node];
        }
    }

private:
    std::vector<Vec3f> load_, missing_; // N
};

/// Out-of-balance over applied force, by their root sums of squares. The force is a running mean over
/// `calm_steps` steps: in a single step it carries the rounding of single-precision displacements, 4e-4 of
/// the weight at 100 kPa.
class Balance {
public:
    explicit Balance(std::vector<Index> nodes) : nodes_(std::move(nodes)), mean_(nodes_.size()) {}

    double watch(const Engine& engine) {
        watched_ = std::min(watched_ + 1, averaged_steps);
        double net = 0, applied = 0;
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const Vec3 now = net_force(engine.packing, engine.nodes, engine.constants, nodes_[i]);
            mean_[i] += (1.0 / watched_) * (now - mean_[i]);
            const Vec3 force = applied_force(engine.nodes, engine.constants, nodes_[i]);
            net += dot(mean_[i], mean_[i]);
            applied += dot(force, force);
        }
        return applied > 0 ? std::sqrt(net / applied) : 0;
    }
    /// Without an applied force anything is in balance that settle is asked to look at.
    bool is_loaded(const Engine& engine) const {
        return std::any_of(nodes_.begin(), nodes_.end(), [&](Index node) {
            return applied_force(engine.nodes, engine.constants, node) != Vec3{};
        });
    }

private:
    std::vector<Index> nodes_;
    std::vector<Vec3> mean_; // N
    int watched_ = 0;        // steps
};

/// Kinetic damping (Day 1965, Cundall 1976): the motion is stopped whenever its kinetic energy has passed a
/// peak, which is near where the forces balance. Pieces that fall go on falling.
class KineticDamping {
public:
    explicit KineticDamping(std::vector<Index> nodes) : nodes_(std::move(nodes)) {}

    void watch(Engine& engine) {
        const double now = kinetic(engine);
        const bool is_past = now < past_peak * peak_;
        if (is_past) { stop(engine); }
        peak_ = is_past ? 0 : std::max(peak_, now);
    }
    void stop(Engine& engine) const {
        engine.work.settling += kinetic(engine);
        for (const Index node : nodes_) {
            engine.nodes.velocity[row(node)] = {};
            place_node(engine.packing, engine.nodes, node);
        }
    }

private:
    double kinetic(const Engine& engine) const {
        double energy = 0;
        for (const Index node : nodes_) {
            const Vec3 v = to_double(engine.nodes.velocity[row(node)]);
            energy += static_cast<double>(engine.nodes.mass[row(node)]) / 2 * dot(v, v);
        }
        return energy;
    }

    std::vector<Index> nodes_;
    double peak_ = 0; // J, since the last stop
};

/// Steps until calm; the report says how it ended.
void step_to_rest(Engine& engine, double residual, double at_most, StepReport& report) {
    const std::vector<Index> nodes = find_supported_nodes(engine);
    Balance balance(nodes);
    KineticDamping damping(nodes);
    if (!balance.is_loaded(engine)) {
        report.status = Status::ok;
        return;
    }
    const Easing easing(engine);
    const double eased = std::min(easing_time, at_most / 3) / engine.tissue.time_step;
    double ratio = 1;
    for (int calm = 0; calm < calm_steps; ++report.steps) {
        if (static_cast<double>(report.steps) * engine.tissue.time_step >= at_most) {
            report.status = Status::not_settled;
            report.reason =
                fmt::format("not settled in {:g} s: {:.2g} of the applied force is out of balance, {:.2g} "
                            "was asked for; allow more time, or a larger residual",
                            at_most, ratio, residual);
            break;
        }
        const double share = std::min(1.0, static_cast<double>(report.steps + 1) / eased);
        easing.ease(engine, share);
        if (!step_motion(engine)) {
            report.status = Status::diverged;
            report.element = find_diverged_element(engine, report.reason);
            break;
        }
        if (share == 1) { ratio = balance.watch(engine); }
        calm = share == 1 && ratio <= residual ? calm + 1 : 0;
        damping.watch(engine);
        check_strain_if_due(engine);
    }
    easing.ease(engine, 1);
    damping.stop(engine);
}

} // namespace

StepReport settle_engine(Engine& engine, double residual, double at_most) {
    StepReport report;
    step_to_rest(engine, residual, at_most, report);
    engine.strain = {};
    check_strain_now(engine);
    engine.clock_start = engine.step;
    engine.clock_before = 0;
    engine.carried = 0;
    engine.swept = engine.nodes.displacement;
    return report;
}

} // namespace resect
