// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "resect/body.hpp"
#include "resect/setup.hpp"

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

/// Takes a blade away and ends its stroke. If it is to be completed, the blade first goes on in the direction
/// of its last motion, longer than the body, until it has left the tissue, which is held still meanwhile.
struct LiftBlade {
    Index blade = 0;
    bool complete = false;
};

/// Moves element nodes to given displacements (m) in the next step and holds them there; no displacement:
/// lets them go.
struct Prescribe {
    std::vector<Index> nodes = {}; // rows of Body::elements.nodes
    std::vector<Vec3> displacement = {};
};

/// Takes hold of the tissue whose material lies within `radius` of `at` now, m: it follows the grasp, and is
/// pinned while that does not move. What is fixed or held already stays as it is.
struct Grasp {
    Index grasp = 0;
    Vec3 at = {};
    double radius = 0;
};

/// Moves a grasp, in a straight line spread evenly over the next Simulation::advance().
struct MoveGrasp {
    Index grasp = 0;
    Vec3 to = {};
};

/// Lets go.
struct Release {
    Index grasp = 0;
};

struct SetGravity {
    Vec3 gravity = {}; // m/s^2
};

/// Gives a region another material; its density stays. The time step is chosen anew, as Setup::time_step
/// says. What is strained stores energy in proportion: stiffening it by much drives it.
struct SetMaterial {
    Index region = 0; // row of Setup::materials
    Material material = {};
};

/// Goes back to where the last stroke that is not undone began: a blade was placed, or cut() called.
/// Everything is as it was, time included; the record goes on. The last 32 strokes are kept, fewer of very
/// large bodies.
struct Undo {};

/// One vocabulary for C++, scenes and records.
using Command =
    std::variant<MoveBlade, LiftBlade, Prescribe, SetGravity, Undo, Grasp, MoveGrasp, Release, SetMaterial>;

struct Recorded {
    std::int64_t step = 0; // since creation, at which it was told
    Command command = {};
    std::int64_t until = 0; // step at which the advance() after it ended: blades and grasps had arrived
};

} // namespace resect
