// SPDX-License-Identifier: Apache-2.0
// Cuts a liver in two while it moves, and writes what is left as liver_cut.obj.
#include <cstdio>

#include "resect/resect.hpp"

using namespace resect;

int main() {
    Simulation sim = must(Simulation::create({.body = must(make_liver({.elements = 6097})),
                                              .fixed = {{.box = {.lo = {-1, -1, -1}, .hi = {-0.04, 1, 1}}}},
                                              .damping = 2}));
    sim.settle();
    must(sim.apply(MoveBlade{.to = {{0, 0.1, 0.1}, {0, -0.1, 0.1}}}));
    must(sim.apply(MoveBlade{.to = {{0, 0.1, -0.15}, {0, -0.1, -0.15}}}));
    const StepReport stroke = sim.advance(1.0); // the blade sweeps while the tissue moves
    must(sim.apply(LiftBlade{}));
    std::printf("%d elements cut, %d pieces\n", stroke.cut.elements_cut, stroke.cut.pieces);
    must(write_surface("liver_cut.obj", sim.surface()));
    return stroke.status == Status::ok ? 0 : 1;
}
