// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cut/cutter_state.hpp"
#include "sim/engine.hpp"

// What must be true of a cut body beyond find_broken_invariant, each found by a way of its own.
namespace resect::fuzz {

/// The mass of the nodes and that of the copies, each over `mass` (kg) less one; whichever is farther from 0.
double find_mass_error(const Cutter& cutter, double mass);

/// The least weight of a copy over its floor, min(0.2, 0.5 / k) of its element's weight.
double find_least_weight(const Cutter& cutter);

/// Edges of the surface with more than two triangles.
Index count_pinched_edges(const Cutter& cutter);

/// Faces that strokes tore, and the most copies of one element.
Index count_torn_faces(const Cutter& cutter);
Index find_most_copies(const Cutter& cutter);

/// What is held while nothing is cut: [element] 1 if one of its nodes is held.
std::vector<std::uint8_t> find_held_elements(const Cutter& cutter);

/// A copy of an element in `held_before` that has skin in a held region and no node that is held, or -1.
Index find_lost_constraint(const Cutter& cutter, std::span<const std::uint8_t> held_before);

/// A blade at one end of an increment, and the tissue.
struct Instant {
    BladeFrame frame = {};
    std::vector<Vec3> displacement = {}; // [element node] m
};

/// From a blade's placing to its lifting. A blade that goes on with a stroke adds another way to it.
struct Way {
    Index stroke = 0; // as the cutter counts them
    std::vector<Instant> instants = {};
};

/// How far the torn faces' centroids lie from where the blade went, at rest.
struct SheetDistance {
    double root_mean_square = 0, largest = 0; // m
    Index faces = 0;
};

/// All nodes of an element node must have moved alike.
SheetDistance measure_sheet(const Cutter& cutter, std::span<const Way> ways);

/// Where the solver's arrays are not what S says, in words, or nothing.
std::string find_stale_array(const Engine& engine);

/// The bound of the step at rest, from the copies as the solver has them, s.
double measure_rest_bound(const Engine& engine);

bool is_state_finite(const Engine& engine);

} // namespace resect::fuzz
