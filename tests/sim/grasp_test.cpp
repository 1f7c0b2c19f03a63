// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "bodies.hpp"

using namespace resect;

namespace {

constexpr Vec3 far_corner = {0.1, 0.1, 0.1};

Vec3 place(const Simulation& simulation, std::size_t node) {
    const Nodes nodes = simulation.nodes();
    return to_double(nodes.rest[node]) + to_double(nodes.displacement[node]);
}

/// The node that is nearest to a point at rest.
std::size_t node_at(const Simulation& simulation, const Vec3& point) {
    const Nodes nodes = simulation.nodes();
    std::size_t nearest = 0;
    for (std::size_t node = 0; node < nodes.rest.size(); ++node) {
        const auto distance = [&](std::size_t n) { return length(to_double(nodes.rest[n]) - point); };
        if (distance(node) < distance(nearest)) { nearest = node; }
    }
    return nearest;
}

std::string refusal(Simulation& simulation, const Command& command) {
    const Result<void> applied = simulation.apply(command);
    return applied ? "" : applied.error().message;
}

} // namespace

TEST_CASE("a grasp takes the tissue in reach along, pins it, and lets go") {
    Simulation simulation = must(Simulation::create(held_block(5)));
    const std::size_t node = node_at(simulation, far_corner);
    must(simulation.apply(Grasp{.at = far_corner, .radius = 0.005}));
    CHECK(simulation.pieces().front().held);
    must(simulation.apply(MoveGrasp{.to = far_corner + Vec3{0.02, 0, 0.01}}));
    simulation.advance(0.2);
    CHECK(length(place(simulation, node) - (far_corner + Vec3{0.02, 0, 0.01})) < 1e-7);
    CHECK(simulation.nodes().fixed[node] == 1);
    CHECK(simulation.strain().stretch_max > 1.05);
    simulation.advance(0.2); // pinned
    CHECK(length(place(simulation, node) - (far_corner + Vec3{0.02, 0, 0.01})) < 1e-7);
    CHECK(length(to_double(simulation.nodes().velocity[node])) == 0);
    must(simulation.apply(Release{}));
    simulation.advance(0.3);
    CHECK(simulation.nodes().fixed[node] == 0);
    CHECK(length(place(simulation, node) - far_corner) < 0.01);
}

TEST_CASE("a grasp moves evenly over an advance, and what it pulls does not jerk") {
    Simulation simulation = must(Simulation::create(held_block(4)));
    const std::size_t node = node_at(simulation, far_corner);
    must(simulation.apply(Grasp{.at = far_corner, .radius = 0.005}));
    must(simulation.apply(MoveGrasp{.to = far_corner + Vec3{0.01, 0, 0}}));
    const double step = simulation.time_step().used;
    simulation.advance(100 * step);
    CHECK(double(simulation.nodes().velocity[node][0]) == doctest::Approx(0.01 / (100 * step)).epsilon(1e-3));
}

TEST_CASE("tissue that is cut between two grasps comes apart, each half with its own") {
    Setup setup = free_block(5);
    Simulation simulation = must(Simulation::create(setup));
    must(simulation.apply(Grasp{.grasp = 0, .at = {0, 0.05, 0.05}, .radius = 0.045}));
    must(simulation.apply(Grasp{.grasp = 1, .at = {0.1, 0.05, 0.05}, .radius = 0.045}));
    must(simulation.cut(edge_above(0.047, 0.15), edge_above(0.047, -0.05)));
    must(simulation.apply(MoveGrasp{.grasp = 1, .to = {0.15, 0.05, 0.05}}));
    simulation.advance(0.5);
    REQUIRE(simulation.pieces().size() == 2);
    CHECK(std::abs(simulation.pieces()[0].centre[0] - simulation.pieces()[1].centre[0]) > 0.09);
    CHECK(simulation.strain().stretch_max < 1.2);
}

TEST_CASE(
    "a cut through what is grasped leaves both sides in the grasp, and the bits do not depend on threads") {
    const auto run = [](int threads) {
        Setup setup = held_block(5);
        setup.threads = threads;
        Simulation simulation = must(Simulation::create(setup));
        must(simulation.apply(Grasp{.at = {0.1, 0.05, 0.05}, .radius = 0.04}));
        must(simulation.cut({{0.15, 0.047, 0.15}, {0.05, 0.047, 0.15}},
                            {{0.15, 0.047, -0.05}, {0.05, 0.047, -0.05}}));
        const std::size_t nodes = simulation.nodes().rest.size();
        CHECK(nodes > 216);
        must(simulation.apply(MoveGrasp{.to = {0.11, 0.05, 0.06}}));
        simulation.advance(0.1);
        int moved = 0;
        for (std::size_t node = 216; node < nodes; ++node) {
            const Vec3f u = simulation.nodes().displacement[node];
            moved += length(to_double(u) - Vec3{0.01, 0, 0.01}) < 1e-7 ? 1 : 0;
        }
        CHECK(moved > 3); // nodes that the cut made of grasped ones
        return simulation.hash();
    };
    CHECK(run(1) == run(3));
}

TEST_CASE("a grasp is undone with the stroke, and kept by a snapshot") {
    Simulation simulation = must(Simulation::create(held_block(4)));
    must(simulation.apply(Grasp{.at = far_corner, .radius = 0.005}));
    must(simulation.apply(MoveGrasp{.to = far_corner + Vec3{0, 0, 0.01}}));
    simulation.advance(0.05);
    const Snapshot kept = simulation.snapshot();
    const std::uint64_t hash = simulation.hash();
    must(simulation.cut(edge_above(0.047, 0.15), edge_above(0.047, 0.05)));
    must(simulation.apply(Release{}));
    simulation.advance(0.05);
    must(simulation.apply(Undo{}));
    CHECK(simulation.hash() == hash);
    simulation.advance(0.05);
    const std::uint64_t later = simulation.hash();
    must(simulation.restore(kept));
    simulation.advance(0.05);
    CHECK(simulation.hash() == later);
}

TEST_CASE("grasps that cannot be are refused in one line") {
    Simulation simulation = must(Simulation::create(held_block(4)));
    const double none = std::numeric_limits<double>::quiet_NaN();
    CHECK(refusal(simulation, Grasp{.grasp = 64, .at = far_corner, .radius = 1}) ==
          "grasp 64: grasps are numbered 0 to 63");
    CHECK(refusal(simulation, Grasp{.at = {none, 0, 0}, .radius = 1}) ==
          "grasp 0: the point must be finite and within 1e+06 m of the origin");
    CHECK(refusal(simulation, Grasp{.at = {1, 1, 1}, .radius = 0.01}) ==
          "grasp 0: no free tissue within 0.01 m of the point; grasp nearer to the body, or by a larger "
          "radius");
    CHECK(
        refusal(simulation, Grasp{.at = far_corner, .radius = none}).starts_with("grasp 0: no free tissue"));
    CHECK(refusal(simulation, MoveGrasp{.to = far_corner}) ==
          "grasp 0: holds nothing that could be moved; grasp first");
    CHECK(refusal(simulation, Release{.grasp = 3}) == "grasp 3: holds nothing that could be released");
    must(simulation.apply(Grasp{.at = far_corner, .radius = 0.005}));
    CHECK(refusal(simulation, Grasp{.at = far_corner, .radius = 0.005}) ==
          "grasp 0: holds tissue already; release it first");
}
