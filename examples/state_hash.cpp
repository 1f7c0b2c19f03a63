// SPDX-License-Identifier: Apache-2.0
// Prints the hash of a block that swings and is cut: the same on every processor (scripts/check_neon).
#include <cstdio>

#include "resect/simulation.hpp"

using namespace resect;

int main() {
    Simulation sim = must(Simulation::create({.body = must(make_block({0.1, 0.1, 0.1}, {6, 6, 6})),
                                              .materials = {{.young = 2e4}},
                                              .fixed = {{.box = {.lo = {0, -1, -1}, .hi = {0, 1, 1}}}},
                                              .damping = 2,
                                              .threads = 1}));
    for (int part = 0; part < 4; ++part) {
        sim.advance(0.05);
        if (part == 1) {
            must(sim.cut({{0.05, -0.02, 0.12}, {0.05, 0.12, 0.12}},
                         {{0.055, -0.02, 0.02}, {0.055, 0.12, 0.02}}));
        }
        std::printf("%016llx\n", static_cast<unsigned long long>(sim.hash()));
    }
}
