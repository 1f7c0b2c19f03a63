// SPDX-License-Identifier: Apache-2.0
#include "lab/methods.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

#include "base/clock.hpp"
#include "base/index.hpp"
#include "base/vec.hpp"
#include "lab/calculix.hpp"
#include "lab/linear.hpp"
#include "mesh/tet.hpp"

namespace lab {

using namespace resect;

namespace {

constexpr double snapped = 0.25; // of a cell, that nodes are moved at most where a method moves them
constexpr int steps_timed = 40, times_timed = 5; // the least of which counts
constexpr double longest_run = 1e5;              // steps; who needs more to come to rest is not waited for

CutMesh uncut(const TetMesh& mesh) { return drop_unused_nodes(mesh); }

Setup make_setup(const Problem& problem, const TetMesh& mesh) {
    return {.body = {.elements = mesh},
            .materials = {problem.material},
            .fixed = {{.box = problem.held}},
            .gravity = problem.gravity,
            .damping = 2,
            .threads = 1};
}

double gauge_of(const Problem& problem, const CutSurface& surface) {
    return measure_gauge(surface, problem.gauge[0], problem.gauge[1]);
}

/// Milliseconds that a step takes, the least of some runs of many.
template <class Step>
double time_step_ms(const Step& take_steps) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < times_timed; ++i) {
        Stopwatch watch;
        take_steps();
        least = std::min(least, 1e-3 * watch.lap() / steps_timed);
    }
    return least;
}

double time_steps(Simulation& simulation) {
    return time_step_ms([&] { simulation.advance(steps_timed * simulation.time_step().used); });
}

/// Of the body before it is cut: the gauge's length counts from there.
double uncut_gauge(const Problem& problem) {
    Simulation simulation = must(Simulation::create(make_setup(problem, problem.mesh)));
    simulation.settle();
    return gauge_of(problem, surface_of(simulation));
}

void judge(const Problem& problem, const CutMesh& cut, Outcome& outcome) {
    for (const Vec3& node : cut.mesh.nodes) {
        outcome.unknowns += is_inside(problem.held, node) ? 0 : 3;
    }
    outcome.volume_lost = 1 - volume_of(cut.mesh) / volume_of(problem.mesh);
    outcome.mass_error = -outcome.volume_lost;
}

/// Simulates the mesh that a method made by TLED; `surface_at` makes its surface of the displacements,
/// [node].
template <class Surface>
void hang(const Problem& problem, const CutMesh& cut, const Surface& surface_at, Outcome& outcome) {
    judge(problem, cut, outcome);
    Result<Simulation> made = Simulation::create(make_setup(problem, cut.mesh));
    if (!made) {
        outcome.remark = made.error().message;
        return;
    }
    outcome.step = made->time_step().used;
    outcome.step_ms = time_steps(*made);
    const StepReport rest = made->settle(1e-4, longest_run * outcome.step);
    outcome.surface = surface_at(displacement_of(*made));
    outcome.roughness = measure_roughness(*outcome.surface, problem.sheet);
    if (rest.status == Status::ok) {
        outcome.opening = gauge_of(problem, *outcome.surface) - uncut_gauge(problem);
    } else {
        outcome.remark =
            fmt::format("not at rest after {:.0f} steps of {:.2g} us", longest_run, 1e6 * outcome.step);
    }
}

/// Of a mesh that has come from `before` by way of deleting and splitting.
void hang_edited(const Problem& problem, const CutMesh& cut, const TetMesh& before, Outcome& outcome) {
    hang(
        problem, cut, [&](const std::vector<Vec3>& u) { return surface_of(cut, before, u); }, outcome);
}

/// Our own cut, while the body does not move; its weight pulls from then on.
Simulation cut_at_rest(const Problem& problem, const TetMesh& mesh, const CutOptions& options, double& cut_ms,
                       CutReport& report) {
    Setup setup = make_setup(problem, mesh);
    setup.cut = options;
    Simulation simulation = must(Simulation::create(std::move(setup)));
    must(simulation.apply(SetGravity{})); // so that the body stays at rest: a step for each part of the way
    for (const Edge& pose : problem.sheet.poses()) {
        must(simulation.apply(MoveBlade{.to = pose}));
        const StepReport swept = simulation.advance(simulation.time_step().used);
        cut_ms += 1e-3 * swept.cut.us.total();
        report.copies_added += swept.cut.copies_added;
        report.elements_cut += swept.cut.elements_cut;
    }
    must(simulation.apply(LiftBlade{}));
    must(simulation.apply(SetGravity{problem.gravity}));
    return simulation;
}

/// The mesh that is cut: with nodes near the sheet moved onto it, or as it is.
TetMesh prepare(const Problem& problem, bool moves_nodes) {
    if (!moves_nodes) { return problem.mesh; }
    return snap_nodes(problem.mesh, problem.sheet, snapped * problem.spacing, problem.bounds);
}

double mass_of(const Simulation& simulation) {
    double mass = 0;
    for (const float m : simulation.nodes().mass) {
        mass += double(m);
    }
    return mass;
}

LinearBody make_linear(const Problem& problem, const TetMesh& mesh) {
    return make_linear_body(mesh, problem.material, problem.held, problem.gravity);
}

void judge_linear(const Problem& problem, const CutMesh& cut, const std::vector<Vec3>& u,
                  const std::vector<Vec3>& u_before, Outcome& outcome) {
    judge(problem, cut, outcome);
    outcome.surface = surface_of(cut, problem.mesh, u);
    outcome.roughness = measure_roughness(*outcome.surface, problem.sheet);
    outcome.opening = gauge_of(problem, *outcome.surface) -
                      gauge_of(problem, surface_of(uncut(problem.mesh), problem.mesh, u_before));
}

std::vector<Vec3> solve_uncut(const LinearBody& body) {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(body.unknowns);
    return displacements(body, solve_by_conjugate_gradients(assemble(body), body.force, none, 1e-10).u);
}

/// Displacements of the nodes that are left.
std::vector<Vec3> pick(const std::vector<Vec3>& u, const CutMesh& cut) {
    std::vector<Vec3> picked;
    for (const Index from : cut.node_from) {
        picked.push_back(u[row(from)]);
    }
    return picked;
}

/// Relative to the largest displacement.
double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double difference = 0;
    double size = 0;
    for (std::size_t n = 0; n < a.size(); ++n) {
        difference = std::max(difference, length(a[n] - b[n]));
        size = std::max(size, length(b[n]));
    }
    return difference / size;
}

/// The node in the middle of the side opposite the held one, where a probe may push.
Index find_far_node(const Problem& problem) {
    const Vec3 size = problem.bounds.hi;
    const Vec3 middle = {size[0], 0.5 * size[1], 0.5 * size[2]};
    const auto nearest = std::min_element(
        problem.mesh.nodes.begin(), problem.mesh.nodes.end(),
        [&](const Vec3& a, const Vec3& b) { return length(a - middle) < length(b - middle); });
    return static_cast<Index>(nearest - problem.mesh.nodes.begin());
}

/// The mesh without the tets that are gone.
CutMesh without(const TetMesh& mesh, const std::vector<std::uint8_t>& is_gone) {
    TetMesh left{mesh.nodes, {}};
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        if (is_gone[t] == 0) { left.tets.push_back(mesh.tets[t]); }
    }
    return drop_unused_nodes(left);
}

constexpr Vec3 size = {0.10, 0.08, 0.10}; // m, of the block

/// Draws places between 0 and `whole` towards one of them, where lengths shrink to `finest` of what they
/// were.
double gather(double at, double towards, double whole, double finest) {
    const double side = at < towards ? towards : whole - towards;
    const double share = (at - towards) / side;
    return towards + side * share * (finest + (1 - finest) * std::abs(share));
}

} // namespace

std::vector<Vec3> displacement_of(const Simulation& simulation) {
    std::vector<Vec3> u;
    for (const Vec3f& moved : simulation.nodes().displacement) {
        u.push_back(to_double(moved));
    }
    return u;
}

std::array<Index, 3> block_cells(Index cells) { return {cells, std::max(3, cells * 4 / 5), cells}; }

Problem hang_block(const std::array<Index, 3>& cells, const Notch& notch) {
    constexpr double mouth = 0.05; // m, x of the sheet
    TetMesh mesh = make_jittered_block(size, cells, notch.jitter, notch.seed);
    if (notch.finest < 1) {
        for (Vec3& node : mesh.nodes) {
            node[0] = gather(node[0], mouth - notch.lean, size[0], notch.finest);
            node[2] = gather(node[2], size[2] - notch.depth, size[2], notch.finest);
        }
    }
    return {.mesh = std::move(mesh),
            .bounds = {{0, 0, 0}, size},
            .spacing = size[0] / cells[0],
            .material = {.young = 3e4, .poisson = 0.35, .density = 1000},
            .held = {{-1, -1, -1}, {0, 1, 1}},
            .gravity = {9.81, 0, 0},
            .sheet = flat_notch({mouth, 0, size[2]}, {mouth - notch.lean, 0, size[2] - notch.depth}, size[1]),
            .gauge = {Vec3{mouth - 0.02, 0.04, size[2]}, Vec3{mouth + 0.02, 0.04, size[2]}}};
}

Problem split_into_wall(const std::array<Index, 3>& cells, double jitter, unsigned seed) {
    constexpr double height = 0.025; // m, z of the sheet
    const auto at = [](double x) { return Edge{{x, 1.5 * size[1], height}, {x, -0.5 * size[1], height}}; };
    return {.mesh = make_jittered_block(size, cells, jitter, seed),
            .bounds = {{0, 0, 0}, size},
            .spacing = size[0] / cells[0],
            .material = {.young = 3e5, .poisson = 0.35, .density = 1000},
            .held = {{-1, -1, -1}, {0, 1, 1}},
            .gravity = {0, 0, -9.81},
            .sheet = Sheet({at(1.2 * size[0]), at(-0.2 * size[0])}),
            .gauge = {Vec3{size[0], 0.04, height + 0.02}, Vec3{size[0], 0.04, height - 0.02}}};
}

Problem bow(Problem problem) {
    constexpr int parts = 24;
    std::vector<Edge> poses;
    for (int i = 0; i <= parts; ++i) {
        const double t = static_cast<double>(i) / parts;
        const double y = -0.01 + 0.10 * t;
        const double x = 0.045 + 0.010 * std::sin(std::numbers::pi * t);
        poses.push_back({{x - 0.012, y, 0.13}, {x + 0.008, y, 0.045}});
    }
    problem.sheet = Sheet(std::move(poses));
    return problem;
}

Outcome cut_by_virtual_nodes(const Problem& problem, const CutOptions& options) {
    const bool is_fraction = options.weights == Weights::fraction;
    Outcome outcome{.method = is_fraction ? "Virtual nodes, by fraction" : "Virtual nodes, plain copies",
                    .source = is_fraction ? "Resect" : "the paper"};
    CutReport report;
    Simulation simulation = cut_at_rest(problem, problem.mesh, options, outcome.cut_ms, report);
    for (const std::uint8_t fixed : simulation.nodes().fixed) {
        outcome.unknowns += fixed != 0 ? 0 : 3;
    }
    outcome.volume_lost = 1 - volume_of(simulation.material().material) / volume_of(problem.mesh);
    outcome.mass_error = mass_of(simulation) / (problem.material.density * volume_of(problem.mesh)) - 1;
    outcome.step = simulation.time_step().used;
    simulation.settle();
    outcome.step_ms = time_steps(simulation);
    outcome.surface = surface_of(simulation);
    outcome.roughness = measure_roughness(*outcome.surface, problem.sheet);
    outcome.opening = gauge_of(problem, *outcome.surface) - uncut_gauge(problem);
    outcome.remark =
        fmt::format("{} elements cut, {} copies added", report.elements_cut, report.copies_added);
    return outcome;
}

Outcome cut_by_removal(const Problem& problem) {
    Outcome outcome{.method = "Element removal on TLED", .source = "Cotin 2000; SOFA today"};
    Stopwatch watch;
    const CutMesh cut = remove_elements(problem.mesh, problem.sheet);
    outcome.cut_ms = 1e-3 * watch.lap();
    hang_edited(problem, cut, problem.mesh, outcome);
    return outcome;
}

Outcome cut_along_faces(const Problem& problem, bool moves_nodes) {
    Outcome outcome{.method = moves_nodes ? "Along faces, nodes moved, on TLED" : "Along faces, on TLED",
                    .source = moves_nodes ? "Nienhuys 2001" : "Nienhuys 2000"};
    Stopwatch watch;
    const TetMesh mesh = prepare(problem, moves_nodes);
    const CutMesh cut = split_faces(mesh, problem.sheet);
    outcome.cut_ms = 1e-3 * watch.lap();
    hang_edited(problem, cut, mesh, outcome);
    return outcome;
}

Outcome cut_by_subdivision(const Problem& problem, bool moves_nodes) {
    Outcome outcome{.method = moves_nodes ? "Subdivision, nodes moved, on TLED" : "Subdivision, on TLED",
                    .source = "Bielser 1999; Mor and Kanade 2000"};
    const TetMesh mesh = prepare(problem, moves_nodes);
    CutReport report;
    Simulation ours = cut_at_rest(problem, mesh, {}, outcome.cut_ms, report);
    const CutMesh cut = drop_unused_nodes(ours.material().material);
    hang(
        problem, cut, [&](const std::vector<Vec3>& u) { return surface_of(ours, cut, u); }, outcome);
    return outcome;
}

Outcome cut_along_faces_linear(const Problem& problem) {
    Outcome outcome{.method = "Along faces, linear, conjugate gradients", .source = "Nienhuys 2000"};
    Stopwatch watch;
    const CutMesh cut = split_faces(problem.mesh, problem.sheet);
    outcome.cut_ms = 1e-3 * watch.lap();
    const std::vector<Vec3> before = solve_uncut(make_linear(problem, problem.mesh));
    const LinearBody body = make_linear(problem, cut.mesh);
    const Eigen::SparseMatrix<double> stiffness = assemble(body);
    // From the uncut shape, as a simulator would.
    Eigen::VectorXd start = Eigen::VectorXd::Zero(body.unknowns);
    for (std::size_t n = 0; n < cut.node_from.size(); ++n) {
        const Vec3& u = before[row(cut.node_from[n])];
        if (body.unknown[n] >= 0) { start.segment<3>(body.unknown[n]) << u[0], u[1], u[2]; }
    }
    watch.lap();
    const Solution solution = solve_by_conjugate_gradients(stiffness, body.force, start);
    outcome.step_ms = 1e-3 * watch.lap();
    outcome.remark = fmt::format("{} iterations", solution.iterations);
    judge_linear(problem, cut, displacements(body, solution.u), before, outcome);
    return outcome;
}

Outcome cut_by_woodbury(const Problem& problem) {
    Outcome outcome{.method = "Removal, linear, precomputed inverse", .source = "Zhong 2005; Popescu 2005"};
    LinearBody body = make_linear(problem, problem.mesh);
    const std::vector<Vec3> before = solve_uncut(body);
    Stopwatch watch;
    PrecomputedInverse inverse(body);
    const double precompute = 1e-3 * watch.lap();
    const Index far = find_far_node(problem);
    const Vec3 lift = {0, 0, 1e-3}; // m
    const double uncut_reaction = inverse.reaction(far, lift)[2];
    std::vector<std::uint8_t> is_gone(problem.mesh.tets.size(), 0);
    const std::vector<Index> crossed = find_crossed(problem.mesh, problem.sheet);
    Index kept = 0;
    watch.lap();
    for (const Index tet : crossed) {
        if (inverse.remove(tet)) {
            drop_weight(body, tet);
            is_gone[row(tet)] = 1;
        } else {
            ++kept;
        }
    }
    outcome.cut_ms = 1e-3 * watch.lap();
    const Eigen::VectorXd u = inverse.solve(body.force);
    outcome.step_ms = 1e-3 * watch.lap();
    const CutMesh cut = without(problem.mesh, is_gone);
    const std::vector<Vec3> moved = pick(displacements(body, u), cut);
    judge_linear(problem, cut, moved, before, outcome);
    outcome.remark = fmt::format(
        "inverse {:.1f} s, then {:.1f} ms for each of {} tets ({} kept, for a node would come free); {:.0e} "
        "off a fresh solution; a probe that lifts the far end by 1 mm feels {:.0f} mN, {:.0f} before the cut",
        1e-3 * precompute, outcome.cut_ms / static_cast<double>(crossed.size()), crossed.size() - row(kept),
        kept, largest_difference(moved, solve_uncut(make_linear(problem, cut.mesh))),
        1e3 * inverse.reaction(far, lift)[2], 1e3 * uncut_reaction);
    return outcome;
}

Outcome cut_by_tensor_mass(const Problem& problem) {
    Outcome outcome{.method = "Removal, linear, tensor-mass", .source = "Cotin 2000"};
    LinearBody body = make_linear(problem, problem.mesh);
    const std::vector<Vec3> before = solve_uncut(body);
    TensorMass tissue(body, 20);
    std::vector<std::uint8_t> is_gone(problem.mesh.tets.size(), 0);
    Stopwatch watch;
    for (const Index tet : find_crossed(problem.mesh, problem.sheet)) {
        tissue.remove(tet);
        drop_weight(body, tet);
        is_gone[row(tet)] = 1;
    }
    outcome.cut_ms = 1e-3 * watch.lap();
    outcome.step = 0.9 * tissue.stable_step();
    outcome.step_ms = time_step_ms([&] {
        for (int i = 0; i < steps_timed; ++i) {
            tissue.step(outcome.step);
        }
    });
    const int steps_to_rest = static_cast<int>(1 / outcome.step); // a second, at 20 1/s
    for (int i = 0; i < steps_to_rest; ++i) {
        tissue.step(outcome.step);
    }
    const CutMesh cut = without(problem.mesh, is_gone);
    judge_linear(problem, cut, pick(displacements(body, tissue.u()), cut), before, outcome);
    return outcome;
}

std::optional<double> find_reference_opening(const Problem& problem, bool quadratic,
                                             const std::string& folder) {
    const auto gauge_after = [&](const CutMesh& cut) -> std::optional<double> {
        const std::optional<std::vector<Vec3>> u =
            solve_by_calculix({cut.mesh, problem.material, problem.held, problem.gravity, quadratic}, folder);
        if (!u) { return {}; }
        return gauge_of(problem, surface_of(cut, problem.mesh, *u));
    };
    const std::optional<double> cut = gauge_after(split_faces(problem.mesh, problem.sheet));
    const std::optional<double> whole = gauge_after(uncut(problem.mesh));
    if (!cut || !whole) { return {}; }
    return *cut - *whole;
}

} // namespace lab
