// SPDX-License-Identifier: Apache-2.0
#include "lab/truth.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <random>
#include <span>

#include "base/index.hpp"
#include "base/vec.hpp"
#include "lab/methods.hpp"
#include "lab/reference.hpp"

namespace lab {

using namespace resect;

namespace {

constexpr int seeds = 2; // meshes of a size, jittered each in its own way

struct Variant {
    const char* name = nullptr;
    CutOptions options = {};
    double deeper = 0; // elements by which the blade goes deeper than asked
    double finest = 1; // width of cells about the tip, as a share of even ones
};

/// The problem on a mesh of `cells` along the longer edges, jittered by `seed`, as the variant has it.
using MakeProblem = std::function<Problem(Index cells, unsigned seed, const Variant&)>;

MakeProblem notched(Notch notch) {
    return [notch](Index cells, unsigned seed, const Variant& variant) {
        Notch own = notch;
        const double farther = 1 + variant.deeper * 0.1 / cells / std::hypot(notch.depth, notch.lean);
        own.depth *= farther;
        own.lean *= farther;
        own.seed = seed;
        own.finest = variant.finest;
        return hang_block(block_cells(cells), own);
    };
}

Problem at_wall(Index cells, unsigned seed, const Variant&) {
    return split_into_wall(block_cells(cells), Notch{}.jitter, seed);
}

struct Measured {
    double opening = 0, step = 0; // m, s
};

/// Means over some meshes.
Measured measure_openings(Index cells, const MakeProblem& make, const Variant& variant) {
    Measured mean;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
        const Outcome outcome = cut_by_virtual_nodes(make(cells, seed, variant), variant.options);
        mean.opening += outcome.opening.value_or(0) / seeds;
        mean.step += outcome.step / seeds;
    }
    return mean;
}

double error_percent(double opening, double reference) { return 100 * (opening / reference - 1); }

/// The order p of an error h^p, by least squares of logarithms.
double fit_order(const Series& errors) {
    const auto count = static_cast<Eigen::Index>(errors.x.size());
    const Eigen::ArrayXd x = Eigen::Map<const Eigen::ArrayXd>(errors.x.data(), count).log();
    const Eigen::ArrayXd y = Eigen::Map<const Eigen::ArrayXd>(errors.y.data(), count).log();
    const Eigen::ArrayXd apart = x - x.mean();
    return (apart * y).sum() / apart.square().sum();
}

/// A cut, and what is known of it by other means.
struct Known {
    MakeProblem make = {};
    double opening = 0; // m
    Conforming conforming = {};
};

const Variant variants[] = {{"fraction, soft tip (default)"},
                            {"fraction, tip held", {.front = Front::hold}},
                            {"plain copies, soft tip", {.weights = Weights::copy}},
                            {"fraction, blade one element deeper", {}, 1},
                            {"fraction, elements at the tip 0.4 as wide", {}, 0, 0.4}};

/// Fills in the errors of the variants, and last those of conforming meshes. Returns the stable step of each
/// variant on the finest mesh, s.
std::vector<double> plot_errors(Plot& plot, const Known& known, std::span<const Variant> tried, bool quick) {
    plot.x_label = "edge of an element h, mm";
    plot.y_label = "error of the opening, % (1 where it is less)";
    plot.log_x = plot.log_y = true;
    const std::vector<Index> sizes = quick ? std::vector<Index>{3, 5} : std::vector<Index>{5, 7, 9, 13};
    const auto add = [&](Series& series, Index cells, double opening) {
        series.x.push_back(100.0 / cells);
        series.y.push_back(std::max(1.0, std::abs(error_percent(opening, known.opening))));
    };
    std::vector<double> steps;
    for (const Variant& variant : tried) {
        Series& series = plot.series.emplace_back(Series{.name = variant.name});
        Measured measured;
        for (const Index cells : sizes) {
            measured = measure_openings(cells, known.make, variant);
            add(series, cells, measured.opening);
        }
        steps.push_back(measured.step);
    }
    Series& conforming = plot.series.emplace_back(Series{.name = "conforming mesh (CalculiX)"});
    for (const auto& [cells, opening] : known.conforming) {
        add(conforming, cells, opening);
    }
    return steps;
}

Plot plot_upright(bool quick) {
    Plot plot{.name = "convergence", .title = "A notch half through: error of its opening"};
    const std::vector<double> steps =
        plot_errors(plot, {notched({}), reference_opening(0.05), conforming_openings}, variants, quick);
    const std::vector<double>& ours = plot.series[0].y;
    const std::vector<double>& deeper = plot.series[3].y;
    const std::vector<double>& finer = plot.series[4].y;
    plot.says = fmt::format(
        "All converge from the stiff side, observed orders {:.1f} (ours), {:.1f} (plain copies) "
        "and {:.1f} (conforming). Ours is as stiff as if the cut were one element shorter, since "
        "both sides share the nodes of the element that holds the front. A blade that goes one "
        "element deeper makes up for it, to {:.0f} % on the coarsest mesh and {:.0f} % on the "
        "finest. As many elements, gathered about the tip to 0.4 of their width there, bring {:.0f} "
        "to {:.0f} % down to {:.0f} to {:.0f} %, at steps {:.1f} times smaller. A rule for the "
        "front that does so without tearing deeper was not found: material that is one cannot "
        "move as two.",
        fit_order(plot.series[0]), fit_order(plot.series[2]), fit_order(plot.series.back()), deeper.front(),
        deeper.back(), ours.front(), ours.back(), finer.front(), finer.back(), steps[0] / steps[4]);
    return plot;
}

Plot plot_leaning(bool quick) {
    Plot plot{.name = "convergence_leaning",
              .title = "A notch that leans by 45 degrees: error of its opening"};
    plot_errors(plot,
                {notched({.depth = 0.025, .lean = 0.025}), leaning_opening, leaning_conforming_openings},
                std::span(variants).first(4), quick);
    plot.says = fmt::format(
        "35 mm deep along its slope. The same picture, observed orders {:.1f} (ours), {:.1f} (plain copies) "
        "and {:.1f} (conforming): too stiff by about an element of depth, and mended by as much.",
        fit_order(plot.series[0]), fit_order(plot.series[2]), fit_order(plot.series.back()));
    return plot;
}

/// The cut has no front: it goes into the side that holds the block, and both parts stay held.
Plot plot_wall(bool quick) {
    Plot plot{.name = "convergence_wall",
              .title = "A cut into the wall that holds the block: error of its opening"};
    const Variant tried[] = {variants[0], variants[2]};
    plot_errors(plot, {at_wall, wall_opening, wall_conforming_openings}, tried, quick);
    plot.says = fmt::format(
        "A layer of 25 mm under one of 75 mm, split from the free end into the wall; the opening at the free "
        "end, {:.1f} mm. What is held is material, so both layers stay so. The cut has no front, and what is "
        "left is that four-node tets lock in bending: ours is {:.0f} % off at {:.1f} mm, a conforming mesh "
        "{:.0f} % at {:.1f} mm and {:.0f} % at {:.1f} mm; plain copies, twice as stiff where they are cut, "
        "{:.0f} %.",
        1e3 * wall_opening, plot.series[0].y.back(), plot.series[0].x.back(), plot.series[2].y[2],
        plot.series[2].x[2], plot.series[2].y[3], plot.series[2].x[3], plot.series[1].y.back());
    return plot;
}

Table list_shallow(bool quick) {
    const Index cells = quick ? 5 : 9;
    Table table{.name = "shallow",
                .title = fmt::format("Shallow incisions, elements of {:.1f} mm", 100.0 / cells),
                .columns = {"depth, mm", "depth, elements", "reference, mm", "tip held, mm", "soft tip, mm",
                            "soft tip against reference, %"}};
    std::vector<double> off;
    for (const auto& [depth, reference] : reference_openings) {
        const double held = measure_openings(cells, notched({.depth = depth}), variants[1]).opening;
        const double soft = measure_openings(cells, notched({.depth = depth}), variants[0]).opening;
        table.rows.push_back({number(1e3 * depth), fmt::format("{:.1f}", depth * 10 * cells),
                              fmt::format("{:.3f}", 1e3 * reference), fmt::format("{:.3f}", 1e3 * held),
                              fmt::format("{:.3f}", 1e3 * soft),
                              fmt::format("{:+.0f}", error_percent(soft, reference))});
        off.push_back(error_percent(soft, reference));
    }
    table.says = fmt::format(
        "With a soft tip the shallowest incision opens {:.0f} % less than it should, the deepest {:.0f} %: "
        "one of less than two elements stays nearly shut, since a cut can bend only elements, and the front "
        "takes one.",
        -off.front(), -off.back());
    return table;
}

/// What a cut must not change.
struct Invariants {
    double mass = 0, kinetic = 0, elastic = 0;
    Vec3 momentum = {}, spin = {}; // kg m/s, kg m^2/s
};

Invariants measure(const Simulation& simulation) {
    const Nodes nodes = simulation.nodes();
    Invariants now{.kinetic = simulation.energies().kinetic, .elastic = simulation.energies().elastic};
    for (std::size_t n = 0; n < nodes.mass.size(); ++n) {
        const double mass = double(nodes.mass[n]);
        const Vec3 momentum = mass * to_double(nodes.velocity[n]);
        const Vec3 at = to_double(nodes.rest[n]) + to_double(nodes.displacement[n]);
        now.mass += mass;
        now.momentum += momentum;
        now.spin += cross(at, momentum);
    }
    return now;
}

/// A flying, spinning, swinging block that is cut twice in an instant.
Table list_invariants() {
    Table table{
        .name = "instant",
        .title = "The instant of a cut: relative change of what a cut must keep",
        .columns = {"weights", "cut", "mass", "momentum", "spin", "kinetic energy", "elastic energy"}};
    double most[2] = {}; // of all that is kept, by fractions and by copies
    for (const Weights weights : {Weights::fraction, Weights::copy}) {
        double& largest = most[weights == Weights::fraction ? 0 : 1];
        Setup setup{.body = {.elements = make_jittered_block({0.1, 0.1, 0.1}, {8, 8, 8}, 0.2, 1)},
                    .gravity = {},
                    .cut = {.weights = weights},
                    .threads = 1};
        for (const Vec3& p : setup.body.elements.nodes) {
            setup.initial.velocity.push_back(
                {0.2 + 0.3 * std::sin(40 * p[1]) - 2 * p[2], 0.1 * std::sin(30 * p[2]), 2 * p[0]});
        }
        Simulation simulation = must(Simulation::create(std::move(setup)));
        simulation.advance(0.02);
        const std::pair<Edge, Edge> cuts[] = {
            {{{0.047, -0.5, 0.3}, {0.053, 0.6, 0.3}}, {{0.047, -0.5, -0.2}, {0.053, 0.6, -0.2}}},
            {{{-0.5, 0.044, 0.3}, {0.6, 0.056, 0.3}}, {{-0.5, 0.044, -0.2}, {0.6, 0.056, -0.2}}}};
        int count = 0;
        for (const auto& [from, to] : cuts) {
            const Invariants before = measure(simulation);
            must(simulation.cut(from, to));
            const Invariants after = measure(simulation);
            const auto note = [&](double relative) {
                largest = std::max(largest, relative);
                return number(relative, 2);
            };
            const auto change = [&](double was, double is) { return note(std::abs(is / was - 1)); };
            const auto turn = [&](const Vec3& was, const Vec3& is) {
                return note(length(is - was) / length(was));
            };
            table.rows.push_back({weights == Weights::fraction ? "fraction" : "copy",
                                  count++ == 0 ? "first" : "crossing", change(before.mass, after.mass),
                                  turn(before.momentum, after.momentum), turn(before.spin, after.spin),
                                  change(before.kinetic, after.kinetic),
                                  change(before.elastic, after.elastic)});
        }
    }
    table.says = fmt::format("By fractions a cut changes nothing by more than {:.1g} of it; where elements "
                             "are cut again it may move a little weight between copies that move unlike "
                             "(docs/cutting.md, Weights). Plain copies, the paper's rule, add mass, momentum "
                             "and energy with every cut, here up to {:.0f} %.",
                             most[0], 100 * most[1]);
    return table;
}

/// The step that is stable, after each of many random cuts: ours, and that of the same material were it
/// simulated itself.
Plot plot_steps(bool quick) {
    const int cuts = quick ? 10 : 100;
    Setup setup{.body = {.elements = make_jittered_block({0.1, 0.1, 0.1}, {6, 6, 6}, 0.2, 1)}, .threads = 1};
    const Material material = setup.materials.front();
    Simulation simulation = must(Simulation::create(std::move(setup)));
    Series ours{.name = "virtual nodes"};
    Series subdivided{.name = "subdivision: the material itself"};
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> drawn(0, 1);
    for (int cut = 0; cut <= cuts; ++cut) {
        const Body body = simulation.material();
        const double bound =
            describe({.elements = drop_unused_nodes(body.material).mesh}, material).time_step_bound;
        ours.x.push_back(cut);
        ours.y.push_back(1e6 * simulation.time_step().bound);
        subdivided.x.push_back(cut);
        subdivided.y.push_back(1e6 * bound);
        const auto point = [&] {
            return Vec3{0.1 * drawn(random), 0.1 * drawn(random), 0.1 * drawn(random)};
        };
        const Vec3 at = point();
        const Vec3 along = direction(point() - Vec3{0.05, 0.05, 0.05});
        const Vec3 way = 0.04 * direction(cross(along, point() - at));
        must(simulation.cut({at - 0.03 * along - way, at + 0.03 * along - way},
                            {at - 0.03 * along + way, at + 0.03 * along + way}));
    }
    const double lost = subdivided.y.front() / subdivided.y.back();
    return {.name = "steps",
            .title = "The stable time step over many random cuts",
            .says = fmt::format(
                "By virtual nodes no cut lowers the step. A mesh that is subdivided needs steps {:.0f} times "
                "smaller after {} cuts, and some {:.0f} times as many elements.",
                lost, cuts, static_cast<double>(simulation.material().material.tets.size()) / 1296),
            .x_label = "cuts",
            .y_label = "stable step, us",
            .log_y = true,
            .series = {std::move(ours), std::move(subdivided)}};
}

} // namespace

Section judge_cut_state(bool quick) {
    Section section{.title = "Is the cut state right?"};
    section.text = {
        "The block of the rivals, with a notch; its opening against ten-node tets on a conforming mesh of "
        "9,600 that is split where the blade went (CalculiX; the numbers are stored, lab/reference.hpp). "
        "Jittered meshes whose faces do not lie on the cut, means of two."};
    section.parts = {plot_upright(quick), plot_leaning(quick), plot_wall(quick),
                     list_shallow(quick), list_invariants(),   plot_steps(quick)};
    return section;
}

} // namespace lab
