// SPDX-License-Identifier: Apache-2.0
#include "bench/matrix.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>

namespace bench {

namespace {

using namespace resect;

constexpr double block_edge = 0.1;   // m
constexpr double jitter = 0.2;       // of a cell
constexpr double liver_held = -0.04; // m, held up to this x
constexpr double gravity = 9.81;     // m/s^2
constexpr double density = 1000;     // kg/m^3
constexpr double blade_speed = 0.1;  // m/s
constexpr double deepest = 5;        // lengths that a blade goes down at most
constexpr double clearance = 0.005;  // m, above and below
constexpr int steps_a_pose = 50;     // of the blade, and between two looks at what the simulation reports
constexpr int random_strokes = 20;
constexpr double degree = std::numbers::pi / 180;

Vec3 add(const Vec3& a, double scale, const Vec3& b) {
    return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}

class Random {
public:
    explicit Random(unsigned seed) : generator_(seed) {}
    double between(double lo, double hi) {
        return std::uniform_real_distribution<double>(lo, hi)(generator_);
    }
    Vec3 direction() {
        for (;;) {
            const Vec3 d = {between(-1, 1), between(-1, 1), between(-1, 1)};
            const double size = std::hypot(d[0], d[1], d[2]);
            if (size > 0.1 && size < 1) { return add({}, 1 / size, d); }
        }
    }

private:
    std::mt19937 generator_;
};

Body make_jittered_block(Index cells, Random& random) {
    Body body = must(make_block({block_edge, block_edge, block_edge}, {cells, cells, cells}));
    const double reach = jitter * block_edge / cells;
    for (Vec3& node : body.elements.nodes) {
        for (double& x : node) {
            const bool inside = x > 1e-9 && x < block_edge - 1e-9;
            if (inside) { x += random.between(-reach, reach); }
        }
    }
    return body;
}

/// A blade that moves at one speed in one direction, m.
struct Stroke {
    Edge start = {};
    Vec3 heading = {};
    double travel = 0;
    double area = std::numeric_limits<double>::infinity(); // m^2, torn, after which it stops
    bool through = false; // it also stops once it is below everything that is held
};

Edge pose(const Stroke& stroke, double travelled) {
    return {add(stroke.start.heel, travelled, stroke.heading),
            add(stroke.start.tip, travelled, stroke.heading)};
}

/// A cell that is being run.
class Trial {
public:
    Trial(Simulation simulation, MatrixRow& row) : simulation_(std::move(simulation)), row_(row) {}

    /// Some steps up to the next look at the strain; false once the run has failed.
    bool advance() {
        const StepReport report = simulation_.advance(steps_a_pose * simulation_.time_step().used);
        row_.steps += report.steps;
        row_.elements_cut += report.cut.elements_cut;
        row_.pieces = report.cut.pieces;
        row_.status = report.status;
        row_.reason = report.reason;
        area_ += report.cut.area;
        row_.inverted_most = std::max(row_.inverted_most, simulation_.strain().elements_inverted);
        return report.status == Status::ok;
    }

    bool sweep(const Stroke& stroke) {
        area_ = 0;
        must(simulation_.apply(MoveBlade{.to = stroke.start}));
        const double stride = blade_speed * steps_a_pose * simulation_.time_step().used;
        for (double at = 0; at < stroke.travel && area_ < stroke.area; at += stride) {
            if (stroke.through && pose(stroke, at).tip[2] < lowest() - clearance) { break; }
            must(simulation_.apply(MoveBlade{.to = pose(stroke, at + stride)}));
            if (!advance()) { return false; }
        }
        must(simulation_.apply(LiftBlade{}));
        return true;
    }

    /// Where the nodes of pieces that something holds are now.
    std::vector<Vec3> held_nodes(double* fastest = nullptr) {
        std::set<Index> held;
        for (const Piece& piece : simulation_.pieces()) {
            if (piece.held) { held.insert(piece.id); }
        }
        const Copies copies = simulation_.copies();
        const Nodes nodes = simulation_.nodes();
        std::vector<Vec3> places;
        for (std::size_t copy = 0; copy < copies.node.size(); ++copy) {
            if (!held.contains(copies.piece[copy])) { continue; }
            for (const Index node : copies.node[copy]) {
                const auto at = static_cast<std::size_t>(node);
                const Vec3f &x = nodes.rest[at], &u = nodes.displacement[at], &v = nodes.velocity[at];
                places.push_back(
                    {double(x[0]) + double(u[0]), double(x[1]) + double(u[1]), double(x[2]) + double(u[2])});
                if (fastest != nullptr) {
                    *fastest = std::max(*fastest, std::hypot(double(v[0]), double(v[1]), double(v[2])));
                }
            }
        }
        return places;
    }
    double lowest() {
        double z = std::numeric_limits<double>::infinity();
        for (const Vec3& place : held_nodes()) {
            z = std::min(z, place[2]);
        }
        return z;
    }
    double highest() {
        double z = -std::numeric_limits<double>::infinity();
        for (const Vec3& place : held_nodes()) {
            z = std::max(z, place[2]);
        }
        return z;
    }

    Simulation& simulation() { return simulation_; }

private:
    Simulation simulation_;
    MatrixRow& row_;
    double area_ = 0; // m^2, of this stroke
};

/// Down through `at`, in a vertical plane whose normal lies `turn` degrees from x, by a level blade that is
/// wider than the body.
Stroke cut_down(Trial& trial, const Vec3& at, double turn, double length) {
    const Vec3 along = {-std::sin(turn * degree), std::cos(turn * degree), 0};
    const Vec3 above = {at[0], at[1], trial.highest() + clearance};
    Stroke stroke;
    stroke.start = {add(above, 3 * length, along), add(above, -3 * length, along)};
    stroke.heading = {0, 0, -1};
    stroke.travel = deepest * length;
    stroke.through = true;
    return stroke;
}

/// A finite blade that passes the place of some node of what is held.
Stroke cut_anywhere(Trial& trial, Random& random, double length) {
    const std::vector<Vec3> places = trial.held_nodes();
    const auto pick = static_cast<std::size_t>(random.between(0, 1) * static_cast<double>(places.size()));
    const Vec3 at = places[std::min(pick, places.size() - 1)];
    const Vec3 heading = random.direction();
    const double travel = random.between(0.3, 1) * length, half = random.between(0.15, 0.5) * length;
    const Vec3 any = random.direction();
    const double share = any[0] * heading[0] + any[1] * heading[1] + any[2] * heading[2];
    const Vec3 across = add(any, -share, heading);
    const double size = std::hypot(across[0], across[1], across[2]);
    const Vec3 start = add(at, -travel / 2, heading);
    return {
        {add(start, half / std::max(size, 1e-3), across), add(start, -half / std::max(size, 1e-3), across)},
        heading,
        travel};
}

/// Of the body at rest, where such a stroke goes right through it, m^2.
double section_area(const Setup& setup, const Stroke& stroke) {
    Setup still = setup;
    still.gravity = {};
    Simulation simulation = must(Simulation::create(std::move(still)));
    return must(simulation.cut(stroke.start, pose(stroke, stroke.travel))).area;
}

bool cut(Trial& trial, const Setup& setup, const MatrixRow& row, Random& random) {
    const bool liver = row.cell.tissue == Tissue::liver;
    const double length = row.length;
    // Beyond the held region by 0.35 to 0.55 of the reach, and near the middle across.
    const Vec3 at = {(liver ? liver_held : 0) + random.between(0.35, 0.55) * length,
                     (liver ? 0 : block_edge / 2) + random.between(-0.05, 0.05) * length, 0};
    const double turn = random.between(-15, 15);
    switch (row.cell.cuts) {
    case Cuts::half: {
        Stroke stroke = cut_down(trial, at, turn, length);
        stroke.area = section_area(setup, stroke) / 2;
        return trial.sweep(stroke);
    }
    case Cuts::full:
        return trial.sweep(cut_down(trial, at, turn, length));
    case Cuts::crossing: // lengthwise first: afterwards all would have fallen
        return trial.sweep(cut_down(trial, at, 90 + turn / 2, length)) &&
               trial.sweep(cut_down(trial, at, turn + 30, length)) &&
               trial.sweep(cut_down(trial, at, turn - 30, length));
    case Cuts::random:
        for (int stroke = 0; stroke < random_strokes; ++stroke) {
            if (!trial.sweep(cut_anywhere(trial, random, length))) { return false; }
        }
        return true;
    }
    return false;
}

double reach_of(const Body& body, Tissue tissue) {
    if (tissue == Tissue::block) { return block_edge; }
    double most = liver_held;
    for (const auto& tet : body.material.tets) {
        for (const Index vertex : tet) {
            most = std::max(most, body.material.nodes[static_cast<std::size_t>(vertex)][0]);
        }
    }
    return most - liver_held;
}

} // namespace

const char* name(Tissue tissue) { return tissue == Tissue::block ? "block" : "liver"; }

const char* name(Cuts cuts) {
    switch (cuts) {
    case Cuts::half:
        return "half";
    case Cuts::full:
        return "full";
    case Cuts::crossing:
        return "crossing";
    case Cuts::random:
        return "random";
    }
    return "";
}

std::vector<MatrixCell> list_cells(unsigned seeds) {
    std::vector<MatrixCell> cells;
    for (const Tissue tissue : {Tissue::block, Tissue::liver}) {
        for (const Cuts cuts : {Cuts::half, Cuts::full, Cuts::crossing, Cuts::random}) {
            for (const double load : {0.05, 0.2, 0.4}) {
                for (unsigned seed = 1; seed <= seeds; ++seed) {
                    cells.push_back({tissue, cuts, load, seed});
                }
            }
        }
    }
    return cells;
}

MatrixRow run_cell(const MatrixCell& cell, const MatrixSize& size) {
    Random random(cell.seed);
    const bool liver = cell.tissue == Tissue::liver;
    MatrixRow row;
    row.cell = cell;
    Setup setup{.body = liver ? must(make_liver({.elements = size.liver_elements}))
                              : make_jittered_block(size.block_cells, random),
                .fixed = {{.box = {{-1, -1, -1}, {liver ? liver_held : 0, 1, 1}}}},
                .damping = 2,
                .threads = 1};
    row.length = reach_of(setup.body, cell.tissue);
    row.young = density * gravity * row.length / cell.load_number;
    row.elements = static_cast<Index>(setup.body.elements.tets.size());
    setup.materials = {{.young = row.young, .density = density}};
    setup.gravity = {0, 0, -gravity};

    Trial trial(must(Simulation::create(setup)), row);
    if (cut(trial, setup, row, random)) {
        for (std::int64_t step = 0; step < size.steps_after && trial.advance(); step += steps_a_pose) {}
    }
    const Strain strain = trial.simulation().strain();
    row.inverted_end = strain.elements_inverted;
    row.stretch_min = strain.stretch_min;
    row.stretch_max = strain.stretch_max;
    trial.held_nodes(&row.speed_end);
    return row;
}

} // namespace bench
