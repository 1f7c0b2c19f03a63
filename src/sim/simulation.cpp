// SPDX-License-Identifier: Apache-2.0
#include "resect/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/hash.hpp"
#include "fem/choose_kernels.hpp"
#include "sim/engine.hpp"
#include "sim/snapshot.hpp"

namespace resect {

namespace {

constexpr double steps_at_most = 1e10; // of one advance
constexpr double sweep_every = 1e-3;   // s, where steps are shorter
constexpr Index blade_of_cut = 64;     // beside the caller's own

StepReport diverged(Engine& engine, StepReport report) {
    report.cut.pieces = count_pieces(*engine.cutter);
    report.status = Status::diverged;
    report.element = find_diverged_element(engine, report.reason);
    return report;
}

void note_arrival(Engine& engine, std::int64_t step) {
    for (; engine.carried_out < engine.record.size(); ++engine.carried_out) {
        engine.record[engine.carried_out].until = step;
    }
}

/// Some blade has yet to go where it was told to.
bool is_under_way(const Engine& engine) {
    return std::any_of(engine.blades.begin(), engine.blades.end(),
                       [](const BladeWay& way) { return !way.poses.empty(); });
}

} // namespace

Engine& engine_of(Simulation& simulation) { return *simulation.engine_; }

Simulation::Simulation(std::unique_ptr<Engine> engine) : engine_(std::move(engine)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Result<Simulation> Simulation::create(Setup setup) {
    Result<std::unique_ptr<Engine>> engine = build_engine(std::move(setup));
    if (!engine) { return engine.error(); }
    return Simulation(std::move(*engine));
}

Result<void> Simulation::apply(const Command& command) { return apply_command(*engine_, command); }

StepReport Simulation::advance(double seconds) {
    Engine& engine = *engine_;
    StepReport report;
    const double asked = (engine.carried + seconds) / engine.tissue.time_step;
    if (!(seconds >= 0 && asked <= steps_at_most)) {
        report.status = Status::refused;
        report.reason = fmt::format("advance({:g}): give seconds from 0 to {:g}", seconds,
                                    steps_at_most * engine.tissue.time_step);
        return report;
    }
    // The small excess lets n times a step of 1 / n make n steps, whatever the rounding.
    const std::int64_t steps = static_cast<std::int64_t>(std::floor(asked + 1e-6));
    report.cut = std::exchange(engine.between, {});
    if (steps > 0) { note_arrival(engine, engine.step + steps); }
    engine.carried += seconds - static_cast<double>(steps) * engine.tissue.time_step;
    const std::int64_t stride =
        std::max<std::int64_t>(1, static_cast<std::int64_t>(sweep_every / engine.tissue.time_step));
    while (report.steps < steps) {
        engine.left = steps - report.steps;
        const bool is_sound = step_motion(engine);
        engine.left = 1;
        if (!is_sound) { return diverged(engine, report); }
        ++report.steps;
        const std::int64_t left = steps - report.steps;
        if (engine.step % stride == 0 || (left == 0 && is_under_way(engine))) {
            sweep_blades(engine, (left + stride - 1) / stride + 1, report.cut);
        }
        check_strain_if_due(engine);
    }
    report.cut.pieces = count_pieces(*engine.cutter);
    return report;
}

Result<void> Simulation::replay(std::span<const Recorded> commands, std::int64_t until) {
    const auto advance_to = [&](std::int64_t step) -> Result<void> {
        const std::int64_t left = step - engine_->step;
        if (left <= 0) { return {}; }
        const StepReport report = advance(static_cast<double>(left) * engine_->tissue.time_step);
        if (report.status == Status::ok) { return {}; }
        return Error{report.reason};
    };
    std::int64_t arrival = 0;
    for (std::size_t i = 0; i < commands.size(); ++i) {
        const Recorded& told = commands[i];
        for (const std::int64_t step : {std::min(arrival, told.step), told.step}) {
            if (Result<void> advanced = advance_to(step); !advanced) { return advanced; }
        }
        if (const Result<void> applied = apply(told.command); !applied) {
            return Error{fmt::format("command {} of the record: {}", i, applied.error().message)};
        }
        arrival = told.until;
    }
    if (Result<void> advanced = advance_to(std::min(arrival, until)); !advanced) { return advanced; }
    return advance_to(until);
}

StepReport Simulation::settle(double residual, double at_most) {
    if (!(residual > 0 && at_most >= 0 && at_most / engine_->tissue.time_step <= steps_at_most)) {
        return {.status = Status::refused, .reason = "settle: give a residual above 0 and a time from 0"};
    }
    if (!engine_->blades.empty()) {
        return {.status = Status::refused, .reason = "settle: a blade is placed; lift it first"};
    }
    StepReport report = settle_engine(*engine_, residual, at_most);
    report.cut.pieces = count_pieces(*engine_->cutter);
    return report;
}

Result<CutReport> Simulation::cut(Edge from, Edge to) {
    for (const Edge& edge : {from, to}) {
        if (const Result<void> checked = check_edge(edge); !checked) {
            return Error{fmt::format("cut: {}", checked.error().message)};
        }
    }
    CutReport report;
    remember_stroke(*engine_);
    place_blade(*engine_->cutter, blade_of_cut, from, engine_->nodes.displacement);
    sweep_still(*engine_, blade_of_cut, from, to, report);
    lift_blade(*engine_->cutter, blade_of_cut);
    report.pieces = count_pieces(*engine_->cutter);
    return report;
}

Surface Simulation::surface(std::uint64_t since_revision) {
    return update_surface(*engine_->cutter, engine_->nodes.displacement, since_revision);
}

Nodes Simulation::nodes() const {
    const NodeArrays& nodes = engine_->nodes;
    return {.rest = nodes.rest,
            .displacement = nodes.displacement,
            .velocity = nodes.velocity,
            .mass = nodes.mass,
            .fixed = engine_->fixed,
            .reference = simulation_mesh(*engine_->cutter).node_reference};
}

Copies Simulation::copies() const {
    const SimulationMesh& mesh = simulation_mesh(*engine_->cutter);
    return {.node = mesh.copy_node,
            .element = mesh.copy_element,
            .piece = piece_of_copy(*engine_->cutter),
            .fraction = mesh.copy_fraction};
}

Body Simulation::material() const {
    Body body = material_body(*engine_->cutter);
    body.region = engine_->model.region;
    return body;
}

std::vector<double> Simulation::von_mises() const {
    std::vector<double> stress(row(engine_->elements.count));
    for (std::size_t copy = 0; copy < stress.size(); ++copy) {
        stress[copy] = von_mises_stress(engine_->elements, engine_->nodes, static_cast<Index>(copy));
    }
    return stress;
}

std::vector<Index> Simulation::surface_copies() { return copy_of_triangle(*engine_->cutter); }

std::span<const Piece> Simulation::pieces() {
    return update_pieces(*engine_->cutter, engine_->nodes.displacement, engine_->fixed);
}

std::span<const Recorded> Simulation::record() const { return engine_->record; }

Index Simulation::undoable_strokes() const { return static_cast<Index>(engine_->strokes.size()); }

/// All at the half step behind, where the velocity is: there the works of the dampings and the energies
/// balance.
std::span<const Material> Simulation::materials() const { return engine_->tissue.materials; }

Vec3 Simulation::gravity() const { return to_double(engine_->constants.gravity); }

Energies Simulation::energies() const {
    const Engine& engine = *engine_;
    const NodeArrays& nodes = engine.nodes;
    const Vec3 gravity = to_double(engine.constants.gravity);
    const auto half_step = static_cast<float>(engine.tissue.time_step / 2);
    Energies energies{.kinetic = kinetic_energy(nodes)};
    std::vector<Vec3f> behind(nodes.mass.size());
    for (std::size_t node = 0; node < behind.size(); ++node) {
        behind[node] = nodes.displacement[node] - half_step * nodes.velocity[node];
        energies.gravity -= static_cast<double>(nodes.mass[node]) * dot(gravity, to_double(behind[node]));
    }
    energies.elastic = elastic_energy(engine.elements, behind);
    const double viscous = engine.work.internal - (energies.elastic - engine.elastic_start);
    energies.damped = engine.work.damping + engine.work.settling + viscous;
    return energies;
}

TimeStep Simulation::time_step() const {
    return {.used = engine_->tissue.time_step,
            .bound = engine_->tissue.rest_bound,
            .live_bound = engine_->live_bound.known};
}

Strain Simulation::strain() const { return engine_->strain; }

std::vector<std::string> Simulation::warnings() const { return find_warnings(*engine_); }

double Simulation::time() const {
    return engine_->clock_before +
           static_cast<double>(engine_->step - engine_->clock_start) * engine_->tissue.time_step;
}

const char* instruction_set() { return kernels().name; }

bool choose_instruction_set(const std::string& name) { return choose_kernels(name); }

std::int64_t Simulation::steps() const { return engine_->step; }

Snapshot Simulation::snapshot() const {
    return Snapshot(std::make_shared<const SnapshotState>(take_snapshot(*engine_)));
}

Result<void> Simulation::restore(const Snapshot& snapshot) {
    if (snapshot.empty()) { return Error{"restore: the snapshot is empty; take one with snapshot() first"}; }
    return restore_snapshot(*engine_, *snapshot.state_);
}

std::uint64_t Simulation::hash() const {
    const NodeArrays& nodes = engine_->nodes;
    return Hash()
        .add(std::span<const Vec3f>(nodes.displacement))
        .add(std::span<const Vec3f>(nodes.velocity))
        .add(hash_topology(*engine_->cutter))
        .add(engine_->step)
        .value();
}

} // namespace resect
