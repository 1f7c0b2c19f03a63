// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "resect/body.hpp"

namespace resect {

/// The blade's segment; the tip is its free end, the heel the handle's. Points in metres.
struct Edge {
    Vec3 heel = {}, tip = {};
};

/// Moves a blade: the first call places it, and cuts nothing; the sweep to a later pose is spread evenly over
/// the next Simulation::advance().
struct MoveBlade {
    Index blade = 0;
    Edge to = {};
};

/// Takes a blade away and ends its stroke.
struct LiftBlade {
    Index blade = 0;
};

/// Moves element nodes to given displacements (m) in the next step and holds them there; no displacement:
/// lets them go.
struct Prescribe {
    std::vector<Index> nodes = {};
    std::vector<Vec3> displacement = {};
};

struct SetGravity {
    Vec3 gravity = {}; // m/s^2
};

/// One vocabulary for C++, scenes and records.
using Command = std::variant<MoveBlade, LiftBlade, Prescribe, SetGravity>;

struct Recorded {
    std::int64_t step = 0;
    Command command = {};
};

} // namespace resect
