// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <random>

#include "bodies.hpp"

using namespace resect;

namespace {

/// Every node a velocity of its own, and a deformation.
Motion random_motion(const Body& body, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Motion motion;
    for (const Vec3& x : body.elements.nodes) {
        motion.velocity.push_back(
            {0.1 * uniform(generator), 0.1 * uniform(generator), 0.1 * uniform(generator)});
        motion.displacement.push_back({0.01 * std::sin(30 * x[1]), 0.01 * std::sin(25 * x[2]), 0.01 * x[0]});
    }
    return motion;
}

/// Largest distance between vertices that were one, among those with rest.x in [from, to], m.
double opening_between(const Surface& surface, float from, float to) {
    double opening = 0;
    for (std::size_t a = 0; a < surface.rest.size(); ++a) {
        if (surface.rest[a][0] < from || surface.rest[a][0] > to) { continue; }
        for (std::size_t b = a + 1; b < surface.rest.size(); ++b) {
            if (surface.rest[a] != surface.rest[b]) { continue; }
            opening =
                std::max(opening, length(to_double(surface.position[a]) - to_double(surface.position[b])));
        }
    }
    return opening;
}

} // namespace

TEST_CASE("no cut lowers the bound of the step at rest") {
    Simulation simulation = must(Simulation::create(free_block(5)));
    const double bound = simulation.time_step().bound;
    for (const double x : {0.031, 0.047, 0.0523, 0.066}) {
        must(simulation.cut(edge_above(x, 0.2), edge_above(x + 0.02, -0.1)));
    }
    simulation.advance(100 * simulation.time_step().used); // nothing moves; the bound is looked at
    CHECK(simulation.copies().node.size() > 5 * 5 * 5 * 6 + 200);
    CHECK(simulation.time_step().live_bound == doctest::Approx(bound).epsilon(1e-5));
    CHECK(simulation.time_step().bound == bound);
}

TEST_CASE("a first cut by fractions changes neither mass nor momentum nor energy") {
    Setup setup = free_block(6);
    setup.initial = random_motion(setup.body, 3);
    Simulation simulation = must(Simulation::create(setup));
    simulation.advance(0.002);
    const double mass = total_mass(simulation);
    const Vec3 p = momentum(simulation);
    const Energies before = simulation.energies();
    const Vec3 spin = angular_momentum(simulation);
    const double kinetic = kinetic_energy(simulation);
    const CutReport cut = must(simulation.cut(edge_above(0.053, 0.2), edge_above(0.057, -0.1)));
    CHECK(cut.pieces == 2);
    CHECK(cut.elements_cut > 100);
    CHECK(cut.copies_added == cut.elements_cut);
    CHECK(cut.area == doctest::Approx(0.01).epsilon(0.05));
    CHECK(total_mass(simulation) == doctest::Approx(mass).epsilon(1e-6));
    CHECK(length(momentum(simulation) - p) < 1e-6 * mass * 0.1);
    CHECK(simulation.energies().elastic == doctest::Approx(before.elastic).epsilon(1e-5));
    CHECK(length(angular_momentum(simulation) - spin) < 1e-6 * mass * 0.1 * 0.1);
    CHECK(kinetic_energy(simulation) == doctest::Approx(kinetic).epsilon(1e-6));
    double volume = 0;
    for (const Piece& piece : simulation.pieces()) {
        volume += piece.volume;
    }
    CHECK(volume == doctest::Approx(1e-3).epsilon(1e-9));
}

TEST_CASE("a cut by plain copies adds the mass of the elements that it cuts") {
    Setup setup = free_block(6);
    setup.cut.weights = Weights::copy;
    setup.initial = random_motion(setup.body, 3);
    Simulation simulation = must(Simulation::create(setup));
    const double mass = total_mass(simulation), element = mass / (6 * 6 * 6 * 6);
    const CutReport cut = must(simulation.cut(edge_above(0.053, 0.2), edge_above(0.057, -0.1)));
    CHECK(cut.pieces == 2);
    CHECK(total_mass(simulation) == doctest::Approx(mass + cut.copies_added * element).epsilon(1e-6));
    CHECK(simulation.advance(0.05).status == Status::ok);
}

TEST_CASE("a blade that sweeps moving tissue in 10 and in 100 steps leaves the same pieces") {
    std::vector<double> volumes;
    for (const int steps : {10, 100}) {
        Setup setup = held_block(6);
        setup.gravity = {0, 0, -9.81};
        Simulation simulation = must(Simulation::create(setup));
        must(simulation.apply(MoveBlade{.to = edge_above(0.05, 0.2)}));
        must(simulation.apply(MoveBlade{.to = edge_above(0.06, -0.2)}));
        const StepReport report = simulation.advance(steps * simulation.time_step().used);
        CHECK(report.steps == steps);
        CHECK(report.status == Status::ok);
        CHECK(report.cut.pieces == 2);
        for (const Piece& piece : simulation.pieces()) {
            volumes.push_back(piece.volume);
        }
    }
    REQUIRE(volumes.size() == 4);
    CHECK(volumes[0] ==
          doctest::Approx(volumes[2]).epsilon(0.03)); // the tissue sags a little more in 100 steps
}

TEST_CASE("a block that falls onto a blade at rest is cut in two") {
    Setup setup = free_block(6, 5e4);
    setup.gravity = {0, 0, -9.81};
    Simulation simulation = must(Simulation::create(setup));
    must(simulation.apply(MoveBlade{.to = {{0.047, 0.3, -0.01}, {0.049, -0.2, -0.01}}}));
    const StepReport report = simulation.advance(0.3);
    CHECK(report.status == Status::ok);
    CHECK(report.cut.pieces == 2);
    CHECK(report.cut.elements_cut > 100);
}

TEST_CASE("half a cut leaves one piece that opens under its weight") {
    Setup setup = held_block(8);
    setup.gravity = {0, 0, -9.81};
    setup.damping = 5;
    Simulation simulation = must(Simulation::create(setup));
    const CutReport cut = must(simulation.cut(edge_above(0.031, 0.12), edge_above(0.033, 0.05)));
    CHECK(cut.pieces == 1);
    CHECK(cut.area == doctest::Approx(0.005).epsilon(0.2));
    CHECK(simulation.settle().status == Status::ok);
    CHECK(opening_between(simulation.surface(), 0, 1) > 1e-3);
}

TEST_CASE("a cut into the held wall opens there no more than a conforming mesh's") {
    const auto opening_at_wall = [](double z) {
        Setup setup = held_block(8);
        setup.gravity = {0, 0, -9.81};
        Simulation simulation = must(Simulation::create(setup));
        // Horizontal, from the free end into the wall and beyond.
        must(simulation.cut({{0.12, 0.15, z}, {0.12, -0.05, z}}, {{-0.02, 0.15, z}, {-0.02, -0.05, z}}));
        CHECK(simulation.pieces().size() == 2);
        for (const Piece& piece : simulation.pieces()) {
            CHECK(piece.held);
        }
        CHECK(simulation.settle().status == Status::ok);
        return std::pair{opening_between(simulation.surface(), -1, 1e-6F),
                         opening_between(simulation.surface(), 0.005F, 0.0126F)};
    };
    const auto [conforming_wall, conforming_near] = opening_at_wall(0.05); // on nodes: a pure split of faces
    CHECK(conforming_wall == 0);
    for (const double z : {0.0535, 0.0575}) {
        const auto [wall, near] = opening_at_wall(z);
        MESSAGE(fmt::format("z {:.4f}: at the wall {:.3g} m, one element away {:.3g} m; conforming {:.3g} m",
                            z, wall, near, conforming_near));
        CHECK(wall <= 1e-6);
        CHECK(near <= 1.02 * conforming_near);
    }
}

TEST_CASE("the free part of a cut body falls, and the held part stays") {
    Setup setup = held_block(6, 5e4);
    setup.gravity = {0, 0, -9.81};
    Simulation simulation = must(Simulation::create(setup));
    must(simulation.cut(edge_above(0.061, 0.2), edge_above(0.061, -0.1)));
    CHECK(simulation.advance(0.5).status == Status::ok);
    REQUIRE(simulation.pieces().size() == 2);
    for (const Piece& piece : simulation.pieces()) {
        const double fall = 0.05 - piece.centre[2];
        CHECK(fall == doctest::Approx(piece.held ? 0 : 0.5 * 9.81 * 0.25).scale(1).epsilon(0.03));
    }
}
