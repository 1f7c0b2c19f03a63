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

TEST_CASE("a node is not told where to be twice") {
    Simulation simulation = must(Simulation::create(held_block(4)));
    const auto corner = static_cast<Index>(simulation.nodes().reference[node_at(simulation, far_corner)]);
    must(simulation.apply(Grasp{.at = far_corner, .radius = 0.005}));
    CHECK(refusal(simulation, Prescribe{{corner}, {{0.01, 0, 0}}}) ==
          "prescribe: node 124 is grasped; release it first");
    must(simulation.apply(Release{}));
    must(simulation.apply(Prescribe{{corner}, {{0.01, 0, 0}}}));
    CHECK(refusal(simulation, Grasp{.at = far_corner + Vec3{0.01, 0, 0}, .radius = 0.005})
              .starts_with("grasp 0: no free tissue"));
}

TEST_CASE("a side of a cut node that is grasped follows the grasp, and the prescribed one stays") {
    Simulation simulation = must(Simulation::create(held_block(4)));
    const std::size_t node = node_at(simulation, {0.1, 0.05, 0.1});
    const Index reference = simulation.nodes().reference[node];
    must(simulation.apply(Prescribe{{reference}, {{0, 0, 0}}}));
    must(
        simulation.cut({{0.15, 0.06, 0.15}, {0.03, 0.06, 0.15}}, {{0.15, 0.06, -0.05}, {0.03, 0.06, -0.05}}));
    must(simulation.apply(Grasp{.at = {0.1, 0.08, 0.1}, .radius = 0.021}));
    must(simulation.apply(MoveGrasp{.to = {0.1, 0.085, 0.1}}));
    simulation.advance(0.1);
    const Nodes nodes = simulation.nodes();
    CHECK(length(to_double(nodes.displacement[node])) == 0);
    for (std::size_t n = 0; n < nodes.rest.size(); ++n) {
        if (nodes.reference[n] == reference && n != node) {
            CHECK(length(to_double(nodes.displacement[n]) - Vec3{0, 0.005, 0}) < 1e-7);
            CHECK(length(to_double(nodes.velocity[n])) < 0.1);
        }
    }
}

TEST_CASE("a grasp that is torn away ends the run in words, and a stroke begun before brings it back") {
    Simulation simulation = must(Simulation::create(held_block(4)));
    must(simulation.cut(edge_above(0.05, 0.15), edge_above(0.05, 0.08)));
    must(simulation.apply(Grasp{.at = far_corner, .radius = 0.03}));
    must(simulation.apply(MoveGrasp{.to = {1e6, -1e6, 1e6}}));
    const StepReport report = simulation.advance(0.05);
    CHECK(report.status == Status::diverged);
    CHECK(report.reason.starts_with("diverged in step "));
    for (const Vec3f& u : simulation.nodes().displacement) {
        CHECK(is_finite(u));
    }
    must(simulation.apply(Undo{}));
    CHECK(simulation.advance(0.05).status == Status::ok);
}

TEST_CASE("twenty grasps in one place, all let go, leave a body that comes to rest") {
    Simulation simulation = must(Simulation::create(held_block(4)));
    std::vector<Index> held;
    for (Index grasp = 0; grasp < 20; ++grasp) {
        const double radius = 0.02 + 0.004 * grasp; // some find nothing that is not grasped yet
        if (refusal(simulation, Grasp{.grasp = grasp, .at = far_corner, .radius = radius}) != "") {
            continue;
        }
        held.push_back(grasp);
        must(simulation.apply(MoveGrasp{.grasp = grasp, .to = far_corner + Vec3{0, 0, 0.001 * (grasp % 3)}}));
        CHECK(simulation.advance(0.01).status == Status::ok);
    }
    CHECK(held.size() > 5);
    for (const Index grasp : held) {
        must(simulation.apply(Release{.grasp = grasp}));
        CHECK(refusal(simulation, Release{.grasp = grasp}) != "");
    }
    Simulation still = must(Simulation::create(held_block(4)));
    must(still.apply(Grasp{.at = {}, .radius = std::numeric_limits<double>::infinity()})); // all of it
    CHECK(still.advance(0.05).status == Status::ok);
    CHECK(simulation.advance(1).status == Status::ok);
    CHECK(simulation.strain().elements_inverted == 0);
}
