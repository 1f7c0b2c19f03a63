// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "resect/simulation.hpp"

#include "case.hpp"

namespace resect::fuzz {

/// What strokes did.
struct Counts {
    Index cases = 0, failures = 0;
    Index strokes = 0, strokes_with_copy = 0;
    std::int64_t crossings = 0, bisections = 0, torn_faces = 0, copies = 0, refused = 0;
    Index pinched_edges = 0;
    Index most_copies = 1, most_tets = 0;                          // of an element, of a body
    double least_weight = std::numeric_limits<double>::infinity(); // over its floor
    double sheet_distance = 0;                                     // largest root mean square, mean edges
    double energy_of_strokes = 0, energy_of_motion = 0;            // most added, as shares (run.cpp)
    std::map<std::string, Index> reasons = {};                     // of refusals
};
void add(Counts& sum, const Counts& counts);
/// The counts in one line.
std::string describe(const Counts& counts);

/// What came of a case: no fault is a pass.
struct Verdict {
    std::vector<std::string> faults = {};
    Counts counts = {};
    std::vector<double> volumes = {}; // of the pieces, m^3, smallest first
    std::uint64_t hash = 0;           // of the topology, and of the motion where there was one
};

Verdict run_case(const Case& replayed);

/// Runs a simulated case whose strokes are made on the way, by what has become of the body: `next` appends
/// one to the case, or returns false.
Verdict run_strokes(Case& drawn, const std::function<bool(Case&, Simulation&)>& next);

} // namespace resect::fuzz
