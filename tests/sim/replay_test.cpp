// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "bodies.hpp"

using namespace resect;

namespace {

Setup swinging_block(int threads) {
    Setup setup = held_block(5);
    setup.gravity = {0, 0, -9.81};
    setup.damping = 2;
    setup.threads = threads;
    return setup;
}

/// A little of everything, in advances of uneven lengths.
void work_on(Simulation& simulation) {
    const double frame = 1.0 / 60;
    simulation.advance(0.03);
    must(simulation.apply(MoveBlade{.to = edge_above(0.06, 0.12)}));
    for (int i = 1; i <= 6; ++i) {
        must(simulation.apply(MoveBlade{.to = edge_above(0.06, 0.12 - 0.016 * i)}));
        simulation.advance(i % 2 == 0 ? frame : 0.7 * frame);
    }
    must(simulation.apply(Grasp{.at = {0.1, 0.05, 0.05}, .radius = 0.04}));
    for (int i = 1; i <= 5; ++i) {
        must(simulation.apply(MoveGrasp{.to = {0.1 + 0.003 * i, 0.05, 0.05}}));
        must(simulation.apply(MoveBlade{.to = edge_above(0.06 + 0.001 * i, 0.02)}));
        simulation.advance(frame);
    }
    must(simulation.apply(LiftBlade{}));
    simulation.advance(0.02);
    must(simulation.apply(Undo{}));
    must(simulation.apply(SetGravity{{0, -3, -9}}));
    must(simulation.apply(MoveBlade{.to = edge_above(0.04, 0.12)}));
    must(simulation.apply(MoveBlade{.to = edge_above(0.045, 0.04)}));
    simulation.advance(0.05);
    must(simulation.apply(LiftBlade{.complete = true}));
    simulation.advance(0.04);
}

} // namespace

TEST_CASE("a record does again what was done, to the last bit, for any number of threads") {
    Simulation done = must(Simulation::create(swinging_block(1)));
    work_on(done);
    REQUIRE(done.pieces().size() == 2);
    for (const int threads : {1, 3}) {
        Simulation again = must(Simulation::create(swinging_block(threads)));
        must(again.replay(done.record(), done.steps()));
        CHECK(again.hash() == done.hash());
        CHECK(again.pieces().size() == 2);
    }
}

TEST_CASE("a record that does not fit its body is refused with the command's number") {
    Simulation simulation = must(Simulation::create(swinging_block(1)));
    const std::vector<Recorded> record = {{.step = 5, .command = SetGravity{}},
                                          {.step = 9, .command = LiftBlade{.blade = 3}}};
    const Result<void> replayed = simulation.replay(record, 20);
    REQUIRE(!replayed);
    CHECK(replayed.error().message ==
          "command 1 of the record: blade 3: is not there to be lifted; place it with MoveBlade first");
    CHECK(simulation.steps() == 9);
}

TEST_CASE("steps of a record that cannot be are refused, and those that lie behind do not go back") {
    Simulation simulation = must(Simulation::create(swinging_block(1)));
    const std::int64_t far = std::numeric_limits<std::int64_t>::max();
    const Result<void> late = simulation.replay(std::vector<Recorded>{{.step = far, .command = Undo{}}}, far);
    REQUIRE(!late);
    CHECK(late.error().message.starts_with("advance("));
    must(
        simulation.replay(std::vector<Recorded>{{.step = -far, .command = SetGravity{}, .until = -far}}, -1));
    CHECK(simulation.steps() == 0);
    must(simulation.replay({}, 7));
    CHECK(simulation.steps() == 7);
}
