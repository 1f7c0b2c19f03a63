// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "resect/simulation.hpp"

#include "case.hpp"
#include "random.hpp"

namespace resect::fuzz {

/// A long blade that turns on a curved way through a waving block: two pieces.
Case draw_sweep(std::uint64_t seed);

/// One to six planes through a block: as many pieces as they have sign vectors.
Case draw_planes(std::uint64_t seed);

/// A body under gravity, without strokes: a jittered block, the liver's lattice or a block with slivers.
Case draw_moving_body(std::uint64_t seed);

/// A stroke at where the body is now: straight, curved, crossing itself, there and back, shallow, with
/// several blades, or through a node, along an edge or in a face of the tissue held still.
Stroke draw_stroke(Random& random, Simulation& simulation);

} // namespace resect::fuzz
