// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <limits>
#include <string>

#include "bodies.hpp"

using namespace resect;

namespace {

bool says(const std::string& message, const std::string& word) {
    return message.find(word) != std::string::npos;
}

} // namespace

TEST_CASE("the step is 0.6 of the rest bound, and one above the bound is refused unless allowed") {
    Simulation simulation = must(Simulation::create(held_block(4)));
    const TimeStep step = simulation.time_step();
    CHECK(step.used == doctest::Approx(0.6 * step.bound));
    CHECK(step.live_bound == doctest::Approx(step.bound).epsilon(1e-3));

    Setup setup = held_block(4);
    setup.time_step = 1.01 * step.bound;
    const Result<Simulation> refused = Simulation::create(setup);
    REQUIRE_FALSE(refused);
    CHECK(says(refused.error().message, "allow_unstable_step"));
    setup.allow_unstable_step = true;
    CHECK(Simulation::create(setup));
}

TEST_CASE("a run that diverges stops with the step, the element and the reason, at its last finite state") {
    Setup setup = held_block(4);
    setup.gravity = {0, 0, -9.81};
    setup.time_step = 3 * must(Simulation::create(setup)).time_step().bound;
    setup.allow_unstable_step = true;
    Simulation simulation = must(Simulation::create(setup));
    const StepReport report = simulation.advance(10);
    CHECK(report.status == Status::diverged);
    CHECK(report.element >= 0);
    CHECK(says(report.reason, "element"));
    CHECK(says(report.reason, fmt::format("step {}", report.steps + 1)));
    for (const Vec3f& u : simulation.nodes().displacement) {
        CHECK(is_finite(u));
    }
    for (const Vec3f& v : simulation.nodes().velocity) {
        CHECK(is_finite(v));
    }
    const std::uint64_t hash = simulation.hash();
    CHECK(simulation.advance(1).status == Status::diverged);
    CHECK(simulation.hash() == hash);
}

namespace {

std::uint64_t hash_after_cut(int threads) {
    Setup setup = held_block(10);
    setup.gravity = {0, 0, -9.81};
    setup.threads = threads;
    Simulation simulation = must(Simulation::create(setup));
    simulation.advance(0.05);
    must(simulation.apply(MoveBlade{.to = edge_above(0.053, 0.12)}));
    must(simulation.apply(MoveBlade{.to = edge_above(0.057, -0.05)}));
    CHECK(simulation.advance(0.1).cut.pieces == 2);
    must(simulation.apply(LiftBlade{}));
    simulation.advance(0.05);
    return simulation.hash();
}

} // namespace

TEST_CASE("the same bits come out for any number of threads, before and after a cut") {
    const std::uint64_t expected = hash_after_cut(1);
    for (const int threads : {2, 3, 8}) {
        CHECK(hash_after_cut(threads) == expected);
    }
}

TEST_CASE("the same bits come out of every instruction set, before and after a cut") {
    const std::string best = instruction_set();
    const std::uint64_t expected = hash_after_cut(2);
    for (const char* set : {"sse2", "avx2", "avx512"}) {
        if (choose_instruction_set(set)) { CHECK(hash_after_cut(2) == expected); }
    }
    choose_instruction_set(best);
}

TEST_CASE("a run in one piece and in ten ends in the same bits") {
    Setup setup = held_block(4);
    setup.gravity = {0, 0, -9.81};
    Simulation whole = must(Simulation::create(setup)), parts = must(Simulation::create(setup));
    whole.advance(0.2);
    for (int part = 0; part < 10; ++part) {
        parts.advance(0.02);
    }
    CHECK(whole.steps() == parts.steps());
    CHECK(whole.hash() == parts.hash());
    CHECK(whole.time() == doctest::Approx(0.2).epsilon(0.01));
}

TEST_CASE("tissue that falls onto a blade at rest is cut the same in one piece and in ten") {
    Setup setup = free_block(3, 2e6);
    setup.gravity = {0, 0, -9.81};
    setup.initial.velocity.assign(setup.body.elements.nodes.size(), {0, 0, -1});
    Simulation whole = must(Simulation::create(setup)), parts = must(Simulation::create(setup));
    CHECK(whole.time_step().used < 5e-4); // several steps to a sweep
    for (Simulation* simulation : {&whole, &parts}) {
        must(simulation->apply(MoveBlade{.to = {{0.047, 0.3, -0.01}, {0.049, -0.2, -0.01}}}));
    }
    whole.advance(0.1);
    for (int part = 0; part < 10; ++part) {
        parts.advance(0.01);
    }
    CHECK(whole.pieces().size() == 2);
    CHECK(whole.hash() == parts.hash());
}

TEST_CASE("settle leaves alone what it has no business with") {
    Setup setup = free_block(3);
    setup.initial.velocity.assign(setup.body.elements.nodes.size(), {0.1, 0, 0});
    Simulation simulation = must(Simulation::create(setup));
    CHECK(simulation.settle().status == Status::ok); // nothing applied: settled at once
    CHECK(simulation.nodes().velocity[0] == to_float(Vec3{0.1, 0, 0}));
    must(simulation.apply(MoveBlade{.to = edge_above(0.05, 1)}));
    CHECK(simulation.settle().status == Status::refused);

    Setup hung = held_block(3);
    hung.gravity = {0, 0, -9.81};
    Simulation coarse = must(Simulation::create(hung));
    CHECK(coarse.settle(1.0).status == Status::ok); // a loose residual leaves the load as it is
    coarse.advance(0.2);
    CHECK(coarse.energies().elastic > 1e-5);
}

TEST_CASE("a body that hangs from prescribed nodes settles") {
    Setup setup = free_block(3);
    setup.gravity = {0, 0, -9.81};
    Simulation simulation = must(Simulation::create(setup));
    Prescribe hold;
    for (std::size_t node = 0; node < setup.body.elements.nodes.size(); ++node) {
        if (setup.body.elements.nodes[node][0] == 0) { hold.nodes.push_back(static_cast<Index>(node)); }
    }
    hold.displacement.resize(hold.nodes.size());
    must(simulation.apply(hold));
    const StepReport report = simulation.settle();
    CHECK(report.status == Status::ok);
    CHECK(report.steps > 100);
    CHECK(largest_displacement(simulation) > 1e-3);
    CHECK(simulation.pieces().front().held);
    must(simulation.apply(Prescribe{hold.nodes, {}}));
    simulation.advance(0.01);
    CHECK(!simulation.pieces().front().held);
}

TEST_CASE("energy lost in a swing is what the dampings took") {
    Setup setup = held_block(6);
    setup.gravity = {0, 0, -9.81};
    setup.damping = 2;
    Simulation simulation = must(Simulation::create(setup));
    for (int part = 0; part < 20; ++part) {
        simulation.advance(0.02);
        const Energies e = simulation.energies();
        CHECK(e.damped >= 0);
        CHECK(e.kinetic + e.elastic + e.gravity + e.damped ==
              doctest::Approx(0).scale(std::abs(e.gravity)).epsilon(0.02));
    }
    CHECK(simulation.energies().damped > 0.01 * std::abs(simulation.energies().gravity));
}

TEST_CASE("prescribed nodes go where they are told, and are let go") {
    Simulation simulation = must(Simulation::create(held_block(4)));
    const TetMesh mesh = must(make_block({0.1, 0.1, 0.1}, {4, 4, 4})).elements;
    Prescribe pull;
    for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
        if (mesh.nodes[node][0] < 0.1 - 1e-9) { continue; }
        pull.nodes.push_back(static_cast<Index>(node));
        pull.displacement.push_back({0.01, 0, 0});
    }
    must(simulation.apply(pull));
    simulation.advance(0.5);
    for (const Index node : pull.nodes) {
        CHECK(simulation.nodes().displacement[row(node)] == to_float(Vec3{0.01, 0, 0}));
        CHECK(simulation.nodes().fixed[row(node)] == 1);
    }
    CHECK(simulation.strain().stretch_max > 1.09);
    pull.displacement.clear();
    must(simulation.apply(pull));
    CHECK(simulation.settle().status == Status::ok); // nothing is applied: settled at once
    simulation.advance(1);
    CHECK(simulation.nodes().fixed[row(pull.nodes.front())] == 0);
    CHECK(simulation.nodes().displacement[row(pull.nodes.front())][0] < 0.009F);
}

TEST_CASE("a load on a free body gives it its momentum") {
    Setup setup = free_block(3);
    setup.loads = {{5, {0, 0.02, 0}}, {20, {0, 0, 0.01}}};
    Simulation simulation = must(Simulation::create(setup));
    simulation.advance(0.2);
    const double time = simulation.time();
    CHECK(length(momentum(simulation) - Vec3{0, 0.02 * time, 0.01 * time}) < 1e-4 * 0.02 * time);
}

TEST_CASE("what cannot be simulated is refused in one line that names it") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    struct Case {
        const char* word;
        void (*spoil)(Setup&);
    };
    static const Case cases[] = {
        {"young", [](Setup& s) { s.materials[0].young = -1; }},
        {"poisson", [](Setup& s) { s.materials[0].poisson = 0.5; }},
        {"density", [](Setup& s) { s.materials[0].density = std::numeric_limits<double>::infinity(); }},
        {"viscous_time", [](Setup& s) { s.materials[0].viscous_time = -2; }},
        {"materials", [](Setup& s) { s.materials.clear(); }},
        {"node set", [](Setup& s) { s.fixed[0].node_set = "wall"; }},
        {"fixed 0",
         [](Setup& s) {
             s.fixed[0].box = {{5, 5, 5}, {6, 6, 6}};
         }},
        {"lo",
         [](Setup& s) {
             s.fixed[0].box = {{1, 0, 0}, {-1, 0, 0}};
         }},
        {"load",
         [](Setup& s) {
             s.loads = {{100000, {0, 0, 1}}};
         }},
        {"gravity",
         [](Setup& s) {
             s.gravity = {0, 0, 1e300};
         }},
        {"damping", [](Setup& s) { s.damping = -1; }},
        {"time_step", [](Setup& s) { s.time_step = -1; }},
        {"threads", [](Setup& s) { s.threads = -3; }},
        {"region", [](Setup& s) { s.body.region.assign(s.body.elements.tets.size(), 4); }},
        {"initial", [](Setup& s) { s.initial.velocity.resize(3); }},
        {"", [](Setup& s) { s.body.elements.tets.clear(); }},
        {"", [](Setup& s) { s.body.elements.tets[3][2] = 1000000; }},
        {"", [](Setup& s) { std::swap(s.body.elements.tets[3][2], s.body.elements.tets[3][1]); }},
        {"", [](Setup& s) { s.body.elements.nodes[7][1] = std::numeric_limits<double>::quiet_NaN(); }},
    };
    for (const Case& one : cases) {
        CAPTURE(one.word);
        Setup setup = held_block(3);
        one.spoil(setup);
        const Result<Simulation> made = Simulation::create(setup);
        REQUIRE_FALSE(made);
        CHECK(says(made.error().message, one.word));
        CHECK(made.error().message.size() > 10);
        CHECK_FALSE(says(made.error().message, "\n"));
    }
    Simulation simulation = must(Simulation::create(held_block(3)));
    const std::uint64_t hash = simulation.hash();
    const Command commands[] = {MoveBlade{.to = {{0, 0, 0}, {0, 0, 0}}},
                                MoveBlade{.to = {{nan, 0, 0}, {0, 0, 1}}},
                                MoveBlade{.blade = -1, .to = edge_above(0, 0)},
                                MoveBlade{.to = {{1e9, 0, 0}, {}}},
                                LiftBlade{},
                                Prescribe{.nodes = {-4}},
                                Prescribe{{1, 2}, {{0, 0, 0}}},
                                Prescribe{{1}, {{nan, 0, 0}}},
                                SetGravity{{nan, 0, 0}}};
    for (const Command& command : commands) {
        CHECK_FALSE(simulation.apply(command));
    }
    CHECK_FALSE(simulation.cut({{0, 0, 0}, {0, 0, 0}}, edge_above(0, 0)));
    CHECK(says(simulation.advance(-1).reason, "seconds"));
    CHECK(simulation.advance(nan).status == Status::refused);
    CHECK(simulation.record().empty());
    CHECK(simulation.hash() == hash);
}

TEST_CASE("a wholly inverted mesh is turned and simulated") {
    Setup setup = held_block(3);
    for (auto& tet : setup.body.elements.tets) {
        std::swap(tet[1], tet[2]);
    }
    setup.gravity = {0, 0, -9.81};
    Simulation simulation = must(Simulation::create(setup));
    CHECK(simulation.advance(0.05).status == Status::ok);
    CHECK(simulation.strain().elements_inverted == 0);
}
