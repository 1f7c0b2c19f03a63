// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/vec.hpp"

namespace resect {

/// State and constants of the simulation nodes, [node]. Velocity is that of half a step before.
struct NodeArrays {
    std::vector<Vec3f> rest, displacement, velocity; // m, m, m/s
    std::vector<Vec3f> next_displacement,
        next_velocity;                     // written by node_update; swapped in once found sound
    std::vector<Vec3f> load;               // N, without gravity
    std::vector<float> mass, inverse_mass; // kg, 1/kg; inverse 0: held or prescribed
};

} // namespace resect
