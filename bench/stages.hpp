// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "resect/simulation.hpp"

namespace bench {

/// What a step is made of.
struct Stages {
    double forces_us = 0, nodes_us = 0; // the least of some runs
    double flops_an_element = 0;        // of the element forces; a fused multiply-add is two
    double bytes_an_element = 0;        // that a step reads and writes, were nothing kept in a cache
};

/// Runs the stages of a step by themselves, again and again on one state, and leaves the motion as it was.
Stages measure_stages(resect::Simulation& simulation);

} // namespace bench
