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

TEST_CASE("material that changes twenty times while a blade is at work harms nothing") {
    Simulation simulation = must(Simulation::create(hanging_block(4e4)));
    must(simulation.apply(Grasp{.at = {0.1, 0.05, 0.05}, .radius = 0.02}));
    must(simulation.apply(MoveBlade{.to = edge_above(0.05, 0.12)}));
    for (int round = 1; round <= 20; ++round) {
        must(simulation.apply(MoveBlade{.to = edge_above(0.05, 0.12 - 0.008 * round)}));
        must(simulation.apply(MoveGrasp{.to = {0.1, 0.05, 0.05 + 0.001 * (round % 2)}}));
        must(simulation.apply(SetMaterial{.material = stiff(round % 2 == 0 ? 4e4 : 8e4)}));
        CHECK(simulation.advance(0.01).status == Status::ok);
    }
    CHECK(simulation.pieces().size() == 2);
    CHECK(simulation.strain().elements_inverted == 0);
}

TEST_CASE("a body that is stiffened by 25 again and again is driven, and never leaves the numbers") {
    Simulation simulation = must(Simulation::create(hanging_block(4e4)));
    for (int round = 1; round <= 30; ++round) {
        must(simulation.apply(SetMaterial{.material = stiff(round % 2 == 0 ? 4e4 : 1e6)}));
        const StepReport report = simulation.advance(0.01);
        CHECK((report.status == Status::ok || report.reason.starts_with("diverged in step ")));
        for (const Vec3f& u : simulation.nodes().displacement) {
            REQUIRE(is_finite(u));
        }
    }
    CHECK(std::isfinite(simulation.energies().elastic));
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
    CHECK(refusal(simulation, SetMaterial{.region = 1}) ==
          "set_material: region 1 is not one of the 1 that the body has");
    CHECK(refusal(simulation, SetMaterial{.material = stiff(-1)}) ==
          "material 0: young is -1; give Pa above 0 and up to 1e12");
    CHECK(refusal(simulation, SetMaterial{.material = {.young = 1e4, .density = 900}}) ==
          "set_material: density is 1000 for good, since masses are made with the body; give that");
    const double none = std::numeric_limits<double>::quiet_NaN();
    CHECK(refusal(simulation, SetMaterial{.material = stiff(none)}).starts_with("material 0: young is nan"));
    CHECK(refusal(simulation, SetMaterial{.material = {.density = none}})
              .starts_with("material 0: density is nan"));
    CHECK(refusal(simulation, SetMaterial{.material = {.viscous_time = none}})
              .starts_with("material 0: viscous_time is nan"));
    CHECK(refusal(simulation, SetMaterial{.material = stiff(4e6)}).starts_with("set_material: time_step "));
    CHECK(simulation.hash() == hash);
    CHECK(simulation.record().empty());
}
