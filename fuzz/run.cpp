// SPDX-License-Identifier: Apache-2.0
#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "oracles.hpp"

namespace resect::fuzz {
namespace {

constexpr double sheet_tolerance = 0.05;   // mean edges
constexpr double mass_tolerance = 1e-12;   // relative
constexpr double weight_tolerance = 1e-12; // relative
constexpr double bound_tolerance = 1e-5;   // relative: the solver's gradients are floats
constexpr Index steps_after_stroke = 200;
/// Above this find_broken_invariant is asked after a stroke, below it after every increment.
constexpr std::size_t most_elements_verified = 2000;

// Kinetic, elastic and gravity's energy together can only fall while the body moves freely: what is held does
// not move, viscosity and damping only take. What they may rise by, as a share of all that gravity has given
// and the body had at the start, is what the leapfrog's energies wobble by: the square of the step over the
// period.
constexpr double energy_tolerance = 0.01;
/// Blades cut without force, but a cut through an element that was cut before moves weight between copies
/// that move and are strained differently, and halves of a sliver weigh more than it did; so a stroke may add
/// this much (docs/cutting.md, "Weights").
constexpr double energy_tolerance_of_stroke = 0.25;

void check_cutter(const Cutter& cutter, double mass, Verdict& verdict) {
    const std::string broken = find_broken_invariant(cutter);
    if (!broken.empty()) { verdict.faults.push_back(broken); }
    const double mass_error = find_mass_error(cutter, mass);
    if (!(std::abs(mass_error) <= mass_tolerance)) {
        verdict.faults.push_back(fmt::format("the mass is off by {:.3g} of it", mass_error));
    }
    const double least_weight = find_least_weight(cutter);
    if (!(least_weight >= 1 - weight_tolerance)) {
        verdict.faults.push_back(fmt::format("a copy weighs {:.6g} times its floor", least_weight));
    }
    verdict.counts.least_weight = std::min(verdict.counts.least_weight, least_weight);
}

void check_expected(const Case& of, Cutter& cutter, Verdict& verdict) {
    const Index pieces = count_pieces(cutter);
    if (of.expected.pieces >= 0 && pieces != of.expected.pieces) {
        verdict.faults.push_back(fmt::format("{} pieces instead of {}", pieces, of.expected.pieces));
    }
    verdict.counts.pinched_edges = count_pinched_edges(cutter);
    if (of.expected.is_unpinched && verdict.counts.pinched_edges > 0) {
        verdict.faults.push_back(
            fmt::format("{} edges of the surface have four triangles", verdict.counts.pinched_edges));
    }
}

void count_up(const Cutter& cutter, Verdict& verdict) {
    Counts& counts = verdict.counts;
    counts.crossings = cutter.tally.crossings;
    counts.bisections = cutter.tally.bisections;
    counts.copies = static_cast<Index>(cutter.mesh.copy_node.size() - cutter.element_volume.size());
    counts.most_copies = find_most_copies(cutter);
    counts.most_tets = cutter.material.tet_count();
    counts.failures = verdict.faults.empty() ? 0 : 1;
    counts.cases = 1;
}

/// An increment that had to be taken back is a fault of ours; material off the integer grid is not.
void note_refusals(const CutReport& report, Verdict& verdict) {
    if (report.refused == 0) { return; }
    verdict.counts.refused += report.refused;
    verdict.counts.reasons[report.reason] += report.refused;
    if (report.reason.starts_with("the blade passed without cutting")) {
        verdict.faults.push_back(report.reason);
    }
}

void list_volumes(std::span<const Piece> pieces, Verdict& verdict) {
    for (const Piece& piece : pieces) {
        verdict.volumes.push_back(piece.volume);
    }
    std::sort(verdict.volumes.begin(), verdict.volumes.end());
}

/// The cutter alone, its nodes moved by the case's waves.
class CutterRun {
public:
    explicit CutterRun(const Case& of) : case_(of), body_(make_body(of.body)) {
        CutterSetup setup;
        for (const Tet& tet : body_.elements.tets) {
            setup.element_mass.push_back(signed_volume(body_.elements, tet)); // 1 kg/m^3
        }
        cutter_ = must(make_cutter(body_, std::move(setup)));
    }

    Verdict run() {
        for (const Stroke& stroke : case_.strokes) {
            run_stroke(stroke);
        }
        check_expected(case_, *cutter_, verdict_);
        check_sheet();
        count_up(*cutter_, verdict_);
        list_volumes(update_pieces(*cutter_, of_nodes(move_elements(0)), cutter_->mesh.node_held), verdict_);
        verdict_.hash = hash_topology(*cutter_);
        return verdict_;
    }

private:
    void run_stroke(const Stroke& stroke) {
        const std::size_t copies = cutter_->mesh.copy_node.size();
        const std::size_t first_way = ways_.size();
        std::vector<Vec3> now = move_elements(0);
        for (std::size_t b = 0; b < stroke.blades.size(); ++b) {
            place_blade(*cutter_, static_cast<Index>(b), stroke.blades[b].front(), of_nodes(now));
            ways_.push_back({cutter_->blades[b].stroke, {{make_frame(stroke.blades[b].front()), now}}});
        }
        CutReport report;
        const Index increments = count_increments(stroke);
        for (Index i = 1; i <= increments; ++i) {
            const std::uint64_t revision = cutter_->revision;
            std::vector<Vec3> next = move_elements(static_cast<double>(i) / increments);
            for (std::size_t b = 0; b < stroke.blades.size(); ++b) {
                const Edge pose = pose_after(stroke, b, i);
                sweep_blade(*cutter_, static_cast<Index>(b), pose, of_nodes(now), of_nodes(next), delta_,
                            report);
                std::vector<Instant>& way = ways_[first_way + b].instants;
                way.push_back({carry_frame(way.back().frame, pose), next});
            }
            now = std::move(next);
            const bool is_small = cutter_->element_volume.size() < most_elements_verified;
            if (is_small && cutter_->revision != revision) { check(); }
        }
        for (std::size_t b = 0; b < stroke.blades.size(); ++b) {
            lift_blade(*cutter_, static_cast<Index>(b));
        }
        check();
        note_refusals(report, verdict_);
        ++verdict_.counts.strokes;
        if (cutter_->mesh.copy_node.size() > copies) { ++verdict_.counts.strokes_with_copy; }
    }

    /// What follows a fault may be its consequence.
    void check() {
        if (verdict_.faults.empty()) { check_cutter(*cutter_, cutter_->initial_volume, verdict_); }
    }

    void check_sheet() {
        const double edge = mean_edge(body_);
        const SheetDistance measured = measure_sheet(*cutter_, ways_);
        verdict_.counts.torn_faces = measured.faces;
        if (!case_.expected.is_on_sheet) { return; }
        verdict_.counts.sheet_distance = measured.root_mean_square / edge;
        if (!(verdict_.counts.sheet_distance <= sheet_tolerance)) {
            verdict_.faults.push_back(
                fmt::format("the torn faces lie {:.3g} mean edges from where the blade went (root mean "
                            "square; {:.3g} at most)",
                            verdict_.counts.sheet_distance, measured.largest / edge));
        }
    }

    /// [element node] At a time of a stroke.
    std::vector<Vec3> move_elements(double time) const {
        std::vector<Vec3> moved;
        moved.reserve(body_.elements.nodes.size());
        for (const Vec3& rest : body_.elements.nodes) {
            moved.push_back(case_.waves.size > 0 ? wave(case_.waves, rest, time) - rest : Vec3{});
        }
        return moved;
    }

    std::vector<Vec3f> of_nodes(const std::vector<Vec3>& moved) const {
        std::vector<Vec3f> displacement;
        displacement.reserve(cutter_->mesh.node_reference.size());
        for (std::size_t n = 0; n < cutter_->mesh.node_reference.size(); ++n) {
            displacement.push_back(to_float(moved[row(cutter_->mesh.node_reference[n])]));
        }
        return displacement;
    }

    const Case& case_;
    Body body_ = {};
    CutterPtr cutter_ = {};
    Delta delta_ = {};
    std::vector<Way> ways_ = {};
    Verdict verdict_ = {};
};

Setup make_setup(const Case& of) {
    Setup setup{.body = make_body(of.body),
                .materials = {{.young = of.forces.young}},
                .gravity = of.forces.gravity,
                .damping = of.forces.damping,
                .threads = 1};
    const Box held = of.body.is_liver ? Box{{0.05, -1, -1}, {1, 1, 1}} : Box{{-1, -1, -1}, {0, 1, 1}};
    setup.fixed = {{.box = held}};
    if (of.forces.kick == 0) { return setup; }
    for (const Vec3& p : setup.body.elements.nodes) {
        setup.initial.velocity.push_back(of.forces.kick *
                                         Vec3{std::sin(40 * p[1]), std::sin(30 * p[2]), std::cos(50 * p[0])});
    }
    return setup;
}

/// The simulation, under gravity.
class StrokesRun {
public:
    explicit StrokesRun(const Case& of)
        : case_(of), simulation_(must(Simulation::create(make_setup(of)))), engine_(engine_of(simulation_)),
          held_before_(find_held_elements(*engine_.cutter)) {
        for (std::size_t n = 0; n < engine_.nodes.mass.size(); ++n) {
            mass_ += simulation_mesh(*engine_.cutter).node_mass[n];
        }
        energy_at_start_ = measure_energy();
        energy_before_ = energy_at_start_;
    }

    Simulation& simulation() { return simulation_; }
    bool has_failed() const { return !verdict_.faults.empty(); }

    void run_stroke(const Stroke& stroke) {
        const std::size_t copies = simulation_mesh(*engine_.cutter).copy_node.size();
        if (stroke.is_still) {
            const std::vector<Edge>& poses = stroke.blades.front();
            const Result<CutReport> cut = simulation_.cut(poses.front(), poses.back());
            if (cut) { note_refusals(*cut, verdict_); }
            if (!cut) { verdict_.faults.push_back(cut.error().message); }
        } else {
            sweep(stroke);
        }
        ++verdict_.counts.strokes;
        if (simulation_mesh(*engine_.cutter).copy_node.size() > copies) {
            ++verdict_.counts.strokes_with_copy;
        }
        check_all();
        check_energy(energy_tolerance_of_stroke, verdict_.counts.energy_of_strokes);
        energy_before_ = measure_energy();
        constexpr int parts = 4;
        for (int part = 0; part < parts && verdict_.faults.empty(); ++part) {
            advance(steps_after_stroke / parts * simulation_.time_step().used);
            check_energy(energy_tolerance, verdict_.counts.energy_of_motion);
        }
        energy_before_ = std::min(energy_before_, measure_energy());
    }

    Verdict finish() {
        Cutter& cutter = *engine_.cutter;
        if (verdict_.faults.empty()) { check_expected(case_, cutter, verdict_); }
        verdict_.counts.torn_faces = count_torn_faces(cutter);
        count_up(cutter, verdict_);
        list_volumes(simulation_.pieces(), verdict_);
        verdict_.hash = simulation_.hash();
        return verdict_;
    }

private:
    void sweep(const Stroke& stroke) {
        const auto blades = static_cast<Index>(stroke.blades.size());
        const auto move = [&](Index increment) {
            for (Index b = 0; b < blades; ++b) {
                const MoveBlade to = {.blade = b, .to = pose_after(stroke, row(b), increment)};
                const Result<void> moved = simulation_.apply(to);
                if (!moved) { verdict_.faults.push_back(moved.error().message); }
            }
        };
        move(0);
        const Index increments = count_increments(stroke);
        for (Index i = 1; i <= increments && verdict_.faults.empty(); ++i) {
            const std::uint64_t revision = engine_.cutter->revision;
            move(i);
            advance(stroke.seconds / increments);
            const bool is_small = engine_.model.rest.size() < most_elements_verified;
            if (is_small && engine_.cutter->revision != revision) { check_all(); }
        }
        for (Index b = 0; b < blades; ++b) {
            simulation_.apply(LiftBlade{.blade = b});
        }
    }

    void advance(double seconds) {
        const StepReport report = simulation_.advance(seconds);
        note_refusals(report.cut, verdict_);
        if (report.status != Status::ok) { verdict_.faults.push_back(report.reason); }
        if (!is_state_finite(engine_)) { verdict_.faults.emplace_back("the motion is not finite"); }
        given_ = std::max(given_, energy_at_start_ - simulation_.energies().gravity);
    }

    /// Kinetic, elastic and gravity's, J.
    double measure_energy() const {
        const Energies energies = simulation_.energies();
        return energies.kinetic + energies.elastic + energies.gravity;
    }

    /// What was added since `energy_before_`, as a share.
    void check_energy(double tolerance, double& most) {
        // Before gravity has done anything a body has nothing to compare with but rounding.
        const double lowered_a_little = 1e-4 * engine_.model.size * mass_ * length(case_.forces.gravity);
        const double share = (measure_energy() - energy_before_) / (given_ + lowered_a_little);
        most = std::max(most, share);
        if (!(share <= tolerance)) {
            verdict_.faults.push_back(
                fmt::format("the energy grew by {:.3g} of all that gravity has given", share));
        }
    }

    /// What follows a fault may be its consequence.
    void check_all() {
        const Cutter& cutter = *engine_.cutter;
        if (!verdict_.faults.empty()) { return; }
        check_cutter(cutter, mass_, verdict_);
        const std::string stale = find_stale_array(engine_);
        if (!stale.empty()) { verdict_.faults.push_back(stale); }
        const Index lost = find_lost_constraint(cutter, held_before_);
        if (lost >= 0) {
            verdict_.faults.push_back(
                fmt::format("copy {} has skin that is held, and no node that is", lost));
        }
        const double bound = measure_rest_bound(engine_);
        if (!(std::abs(bound / engine_.tissue.rest_bound - 1) <= bound_tolerance)) {
            verdict_.faults.push_back(
                fmt::format("the rest bound went from {:.6g} to {:.6g} s", engine_.tissue.rest_bound, bound));
        }
    }

    const Case& case_;
    Simulation simulation_;
    Engine& engine_;
    std::vector<std::uint8_t> held_before_;
    double mass_ = 0;            // kg
    double energy_at_start_ = 0; // J
    double energy_before_ = 0;   // J, when the stroke, or the motion after it, began
    double given_ = 0;           // J, by gravity and at the start, the most at any time
    Verdict verdict_ = {};
};

} // namespace

void add(Counts& sum, const Counts& counts) {
    sum.cases += counts.cases;
    sum.failures += counts.failures;
    sum.strokes += counts.strokes;
    sum.strokes_with_copy += counts.strokes_with_copy;
    sum.crossings += counts.crossings;
    sum.bisections += counts.bisections;
    sum.torn_faces += counts.torn_faces;
    sum.copies += counts.copies;
    sum.refused += counts.refused;
    sum.pinched_edges += counts.pinched_edges;
    sum.most_copies = std::max(sum.most_copies, counts.most_copies);
    sum.most_tets = std::max(sum.most_tets, counts.most_tets);
    sum.least_weight = std::min(sum.least_weight, counts.least_weight);
    sum.sheet_distance = std::max(sum.sheet_distance, counts.sheet_distance);
    sum.energy_of_strokes = std::max(sum.energy_of_strokes, counts.energy_of_strokes);
    sum.energy_of_motion = std::max(sum.energy_of_motion, counts.energy_of_motion);
    for (const auto& [reason, times] : counts.reasons) {
        sum.reasons[reason] += times;
    }
}

std::string describe(const Counts& counts) {
    const double cutting = counts.strokes > 0 ? 100.0 * counts.strokes_with_copy / counts.strokes : 0;
    std::string line = fmt::format(
        "{} cases, {} strokes ({:.0f} % made a copy), {} crossings, {} bisections, {} torn faces, {} copies "
        "(up to {} of an element, {} tets of a body), {} pinched edges, {} refused",
        counts.cases, counts.strokes, cutting, counts.crossings, counts.bisections, counts.torn_faces,
        counts.copies, counts.most_copies, counts.most_tets, counts.pinched_edges, counts.refused);
    if (counts.sheet_distance > 0) { line += fmt::format(", sheet {:.3f} h", counts.sheet_distance); }
    if (counts.energy_of_strokes > 0) {
        line += fmt::format(", energy up by {:.2g} in a stroke and {:.2g} after", counts.energy_of_strokes,
                            counts.energy_of_motion);
    }
    return line + fmt::format(", {} failed", counts.failures);
}

Verdict run_case(const Case& replayed) {
    if (!replayed.is_simulated) { return CutterRun(replayed).run(); }
    StrokesRun run(replayed);
    for (const Stroke& stroke : replayed.strokes) {
        if (!run.has_failed()) { run.run_stroke(stroke); }
    }
    return run.finish();
}

Verdict run_strokes(Case& drawn, const std::function<bool(Case&, Simulation&)>& next) {
    StrokesRun run(drawn);
    while (!run.has_failed() && next(drawn, run.simulation())) {
        run.run_stroke(drawn.strokes.back());
    }
    return run.finish();
}

} // namespace resect::fuzz
