// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/index.hpp"
#include "base/vec.hpp"
#include "lab/linear.hpp"
#include "lab/methods.hpp"
#include "lab/reference.hpp"

namespace lab {

using namespace resect;

namespace {

/// The block of the paper's comparison with Zhong: 1,100 nodes, 4,860 tets (there 1,097 and 4,780).
constexpr std::array<Index, 3> as_zhong = {9, 9, 10};
/// And with Wu and Heng: 140 nodes, 432 tets (there 152 and 416 in the operating region).
constexpr std::array<Index, 3> as_wu_heng = {4, 3, 6};

std::vector<Outcome> cut_by_all(const Problem& problem) {
    return {cut_by_virtual_nodes(problem),     cut_by_virtual_nodes(problem, {.weights = Weights::copy}),
            cut_by_removal(problem),           cut_along_faces(problem, false),
            cut_along_faces(problem, true),    cut_by_subdivision(problem, false),
            cut_by_subdivision(problem, true), cut_along_faces_linear(problem),
            cut_by_woodbury(problem),          cut_by_tensor_mass(problem)};
}

/// A share in percent, to a tenth; rounding alone is zero.
std::string percent(double share) {
    if (std::abs(share) < 1e-6) { return "0"; }
    return std::abs(share) < 5e-4 ? "< 0.1" : fmt::format("{:.1f}", 100 * share);
}

Table list_outcomes(const std::vector<Outcome>& outcomes, double spacing, double reference) {
    Table table{.name = "rivals",
                .title = "One block, one knife, every method",
                .columns = {"method", "after", "unknowns", "roughness, % of h", "volume lost, %",
                            "mass error, %", "opening, mm", "off the reference, %", "stable step, us",
                            "ms a step or solution", "ms for the cut", "real time", "remark"}};
    for (const Outcome& one : outcomes) {
        table.rows.push_back({one.method, one.source, fmt::format("{}", one.unknowns),
                              percent(one.roughness / spacing), percent(one.volume_lost),
                              percent(one.mass_error),
                              one.opening ? fmt::format("{:.2f}", 1e3 * *one.opening) : "none",
                              one.opening ? fmt::format("{:+.0f}", 100 * (*one.opening / reference - 1)) : "",
                              one.step > 0 ? number(1e6 * one.step) : "static", number(one.step_ms),
                              number(one.cut_ms), one.is_real_time() ? "yes" : "no", one.remark});
    }
    return table;
}

/// The tip of a slender beam under its weight, once linear, once not.
Table bend() {
    const TetMesh mesh = make_jittered_block({0.20, 0.03, 0.03}, {20, 3, 3}, 0, 1);
    const Material material{.young = 8e4, .poisson = 0.35, .density = 1000};
    const Box held = {{-1, -1, -1}, {0, 1, 1}};
    const Vec3 gravity = {0, 0, -9.81};
    Setup setup{.body = {.elements = mesh},
                .materials = {material},
                .fixed = {{.box = held}},
                .gravity = gravity,
                .threads = 1};
    Simulation simulation = must(Simulation::create(std::move(setup)));
    simulation.settle(1e-4, 60);
    const std::vector<Vec3> nonlinear = displacement_of(simulation);
    const LinearBody body = make_linear_body(mesh, material, held, gravity);
    const std::vector<Vec3> linear = displacements(
        body,
        solve_by_conjugate_gradients(assemble(body), body.force, Eigen::VectorXd::Zero(body.unknowns)).u);

    Table table{.name = "bend",
                .title = "A beam that bends under its weight",
                .columns = {"model", "angle of the end, degrees", "sag of the end, mm",
                            "end moves back by, mm", "volume, %"}};
    const auto add = [&](const char* name, const std::vector<Vec3>& u) {
        TetMesh bent = mesh;
        for (std::size_t n = 0; n < u.size(); ++n) {
            bent.nodes[n] += u[n];
        }
        const std::size_t end = 20; // nodes run x first: of the lower front edge
        const Vec3 last = bent.nodes[end] - bent.nodes[end - 1];
        table.rows.push_back(
            {name, fmt::format("{:.0f}", std::atan2(-last[2], last[0]) * 180 / std::numbers::pi),
             fmt::format("{:.1f}", -1e3 * u[end][2]), fmt::format("{:.1f}", -1e3 * u[end][0]),
             fmt::format("{:+.1f}", 100 * (volume_of(bent) / volume_of(mesh) - 1))});
    };
    add("nonlinear (TLED)", nonlinear);
    add("linear", linear);
    table.says =
        "A linear model never turns: its beam goes straight down, far too long, and its volume grows.";
    return table;
}

/// A cut that goes right through: the part below the knife hangs by nothing then.
Table free_a_piece() {
    Problem problem = hang_block({5, 4, 5});
    problem.sheet = flat_notch({0.05, 0, 0.2}, {0.05, 0, -0.1}, problem.bounds.hi[1]);
    Table table{.name = "free_piece",
                .title = "A piece comes free",
                .says = "Statics has no answer where a piece comes free: an inverse or a solver of linear "
                        "statics must stop before, or find the piece and take it out. In dynamics it falls.",
                .columns = {"method", "what happens"}};
    Setup setup{.body = {.elements = problem.mesh},
                .materials = {problem.material},
                .fixed = {{.box = problem.held}},
                .gravity = problem.gravity,
                .threads = 1};
    Simulation simulation = must(Simulation::create(std::move(setup)));
    must(simulation.cut(problem.sheet.poses().front(), problem.sheet.poses().back()));
    simulation.advance(0.1);
    double lowest = 0;
    for (const Piece& piece : simulation.pieces()) {
        lowest = std::max(lowest, piece.centre[0]);
    }
    table.rows.push_back(
        {"Virtual nodes on TLED",
         fmt::format("{} pieces; after 0.1 s the free one has fallen by {:.0f} mm (half g t^2: 49 mm)",
                     simulation.pieces().size(), 1e3 * (lowest - 0.075))});
    const LinearBody body = make_linear_body(problem.mesh, problem.material, problem.held, problem.gravity);
    PrecomputedInverse inverse(body);
    const std::vector<Index> crossed = find_crossed(problem.mesh, problem.sheet);
    const auto removed =
        std::count_if(crossed.begin(), crossed.end(), [&](Index tet) { return inverse.remove(tet); });
    table.rows.push_back(
        {"Precomputed inverse",
         fmt::format(
             "{} of {} tets are taken out; the others would make the update singular, and hold the piece",
             removed, crossed.size())});
    const CutMesh cut = split_faces(problem.mesh, problem.sheet);
    const LinearBody parted = make_linear_body(cut.mesh, problem.material, problem.held, problem.gravity);
    const Solution solution =
        solve_by_conjugate_gradients(assemble(parted), parted.force, Eigen::VectorXd::Zero(parted.unknowns));
    table.rows.push_back(
        {"Conjugate gradients", fmt::format("{} after {} iterations; the largest displacement is {:.2g} m",
                                            solution.converged ? "an answer" : "no answer",
                                            solution.iterations, solution.u.cwiseAbs().maxCoeff())});
    return table;
}

Table compare_sizes(bool quick) {
    Table table{.name = "figure_6",
                .title = "The sizes of the paper's figure 6",
                .says =
                    "The last column says who keeps up on this machine. What the paper says of its rivals' "
                    "cut faces is in the roughness, and of their linear tissue in the bend below.",
                .columns = {"size", "method", "unknowns", "ms for the cut", "ms a step or solution",
                            "roughness, % of h", "real time"}};
    const auto add = [&](const char* size, const Problem& problem, const Outcome& one) {
        table.rows.push_back({size, one.method, fmt::format("{}", one.unknowns), number(one.cut_ms),
                              number(one.step_ms), percent(one.roughness / problem.spacing),
                              one.is_real_time() ? "yes" : "no"});
    };
    const Problem small = bow(hang_block(as_wu_heng));
    add("432 tets (Wu and Heng: 416)", small, cut_along_faces_linear(small));
    add("432 tets (Wu and Heng: 416)", small, cut_by_woodbury(small));
    add("432 tets (Wu and Heng: 416)", small, cut_by_virtual_nodes(small));
    if (quick) { return table; }
    const Problem large = bow(hang_block(as_zhong));
    add("4,860 tets (Zhong: 4,780)", large, cut_by_woodbury(large));
    add("4,860 tets (Zhong: 4,780)", large, cut_along_faces_linear(large));
    add("4,860 tets (Zhong: 4,780)", large, cut_by_virtual_nodes(large));
    return table;
}

Strip show_cuts(const std::array<Index, 3>& cells) {
    const Problem problem = bow(hang_block(cells));
    Strip strip{.name = "cuts",
                .title = "The same cut by five methods",
                .camera = {{0.23, -0.22, 0.37}, {0.06, 0.04, 0.045}, 24}};
    const auto add = [&](const char* caption, Outcome outcome) {
        if (outcome.surface) { strip.stills.push_back({caption, std::move(*outcome.surface)}); }
    };
    add("Elements removed", cut_by_removal(problem));
    add("Along faces", cut_along_faces(problem, false));
    add("Along faces, nodes moved", cut_along_faces(problem, true));
    add("Subdivided", cut_by_subdivision(problem, true));
    add("Virtual nodes (ours)", cut_by_virtual_nodes(problem));
    strip.says = "Removal leaves a ragged slot, faces leave steps; subdivision and virtual nodes follow the "
                 "knife. Subdivision pays for it with the time step.";
    return strip;
}

} // namespace

Section compare_rivals(bool quick) {
    Section section{.title = "The rivals"};
    section.text = {
        "A block of 10 x 8 x 10 cm, E = 30 kPa, hangs by one side and is cut half through while it is at "
        "rest; then it comes to rest under its weight. All methods have the same jittered mesh and the same "
        "knife, and run here, on one thread. Opening is what a gauge of 4 cm across the mouth gains by the "
        "cut.",
        "Times are those of this program's versions of these methods, written for this comparison: "
        "whole-mesh edits where a product would edit locally, so compare orders of magnitude.",
        "Not built: the hybrid of Wu and Heng (2004), which condenses what lies outside a small operating "
        "region to the region's rim, once and for all, and solves the region alone by conjugate gradients. "
        "Inside the region it is the linear model that is here, with the same bends and the same free "
        "pieces; outside it nothing can be cut. Its size is in the table of figure 6."};
    const std::array<Index, 3> cells = quick ? std::array<Index, 3>{5, 4, 5} : as_zhong;
    const Problem problem = hang_block(cells);
    const double reference = reference_opening(0.05);
    Table table = list_outcomes(cut_by_all(problem), problem.spacing, reference);
    table.says =
        fmt::format("Reference: {:.2f} mm, ten-node tets on a conforming mesh of 9,600, by CalculiX. Ours is "
                    "as smooth as the knife, loses nothing and keeps the step; and it is the stiffest: a cut "
                    "by virtual nodes opens as if it were about one element shorter (\"Is the cut state "
                    "right?\"). Faces lie off the knife, so a cut along them opens now more, now less than "
                    "it should; removal opens wide, since the slot has taken tissue away.",
                    1e3 * reference);
    section.parts = {std::move(table), show_cuts(cells), compare_sizes(quick), free_a_piece(), bend()};
    return section;
}

} // namespace lab
