// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "bodies.hpp"

using namespace resect;

namespace {

Setup hanging_block(double young) {
    Setup setup = held_block(5, young);
    setup.gravity = {0, 0, -9.81};
    setup.damping = 4;
    return setup;
}

Material stiff(double young) { return {.young = young}; }

double sag(Simulation& simulation) {
    must(simulation.settle(1e-4, 30).status == Status::ok ? Result<int>(0)
                                                          : Result<int>(Error{"not settled"}));
    double lowest = 0;
    for (const Vec3f& u : simulation.nodes().displacement) {
        lowest = std::min(lowest, double(u[2]));
    }
    return -lowest;
}

std::string refusal(Simulation& simulation, const SetMaterial& set) {
    const Result<void> applied = simulation.apply(set);
    return applied ? "" : applied.error().message;
}

} // namespace

TEST_CASE("a body whose material changes comes to rest where one made of that material does") {
    Simulation changed = must(Simulation::create(hanging_block(1e5)));
    Simulation made = must(Simulation::create(hanging_block(4e4)));
    changed.advance(0.1);
    must(changed.apply(SetMaterial{.material = stiff(4e4)}));
    CHECK(changed.time_step().used == made.time_step().used);
    CHECK(changed.time_step().bound == made.time_step().bound);
    const double expected = sag(made);
    CHECK(expected > 0.001);
    CHECK(sag(changed) == doctest::Approx(expected).epsilon(1e-3));
}

TEST_CASE("time goes on evenly while the step changes") {
    Simulation simulation = must(Simulation::create(hanging_block(2e4)));
    simulation.advance(0.1);
    const double before = simulation.time();
    must(simulation.apply(SetMaterial{.material = stiff(8e4)}));
    CHECK(simulation.time() == before);
    simulation.advance(0.1);
    CHECK(simulation.time() == doctest::Approx(0.2).epsilon(0.01));
}

TEST_CASE("a change of material works on a cut body, is undone, replayed and kept by snapshots") {
    Simulation simulation = must(Simulation::create(hanging_block(4e4)));
    simulation.advance(0.05);
    const std::uint64_t at_first = simulation.hash();
    must(simulation.apply(MoveBlade{.to = edge_above(0.05, 0.15)}));
    must(simulation.apply(MoveBlade{.to = edge_above(0.052, 0.05)}));
    simulation.advance(0.1);
    must(simulation.apply(LiftBlade{}));
    must(simulation.apply(SetMaterial{.material = stiff(2e4)}));
    simulation.advance(0.1);
    CHECK(simulation.strain().elements_inverted == 0);
    const Snapshot kept = simulation.snapshot();
    const std::uint64_t hash = simulation.hash();
    {
        Simulation again = must(Simulation::create(hanging_block(4e4)));
        must(again.replay(simulation.record(), simulation.steps()));
        CHECK(again.hash() == hash);
        Simulation other = must(Simulation::create(hanging_block(4e4)));
        must(other.restore(kept));
        CHECK(other.hash() == hash);
        CHECK(other.time_step().used == simulation.time_step().used);
        CHECK(other.time() == simulation.time());
        other.advance(50 * other.time_step().used);
        again.advance(50 * again.time_step().used);
        CHECK(other.hash() == again.hash());
    }
    must(simulation.apply(Undo{}));
    CHECK(simulation.hash() == at_first);
    CHECK(simulation.time_step().used == must(Simulation::create(hanging_block(4e4))).time_step().used);
}

TEST_CASE("energy accounts balance over a change of material") {
    Simulation simulation = must(Simulation::create(hanging_block(4e4)));
    simulation.advance(0.1);
    must(simulation.apply(SetMaterial{.material = stiff(3e4)}));
    simulation.advance(0.3);
    const Energies e = simulation.energies();
    CHECK(e.kinetic + e.elastic + e.gravity + e.damped ==
          doctest::Approx(0).scale(std::abs(e.gravity)).epsilon(0.02));
}

TEST_CASE("materials that cannot be are refused in one line, and nothing changes") {
    Setup setup = hanging_block(4e4);
    setup.time_step = 0.9 * must(Simulation::create(setup)).time_step().used;
    Simulation simulation = must(Simulation::create(setup));
    const std::uint64_t hash = simulation.hash();
    CHECK(refusal(simulation, {.region = 1}) ==
          "set_material: region 1 is not one of the 1 that the body has");
    CHECK(refusal(simulation, {.material = stiff(-1)}) ==
          "material 0: young is -1; give Pa above 0 and up to 1e12");
    CHECK(refusal(simulation, {.material = {.young = 1e4, .density = 900}}) ==
          "set_material: density is 1000 for good, since masses are made with the body; give that");
    CHECK(refusal(simulation, {.material = stiff(4e6)}).starts_with("set_material: time_step "));
    CHECK(simulation.hash() == hash);
    CHECK(simulation.record().empty());
}
