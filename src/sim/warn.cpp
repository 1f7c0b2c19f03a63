// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>

#include "sim/engine.hpp"

// What a simulation says of itself where it is asked for more than was seen to work (docs/method.md, "Cuts
// through soft bodies").
namespace resect {

namespace {

constexpr double trusted_load = 0.2; // load number up to which cuts left no element inverted
constexpr double rounding = 1e-6;

/// Of a point from a box, m.
double distance_from(const Box& box, const Vec3& point) {
    Vec3 away = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        away[axis] = std::max({0.0, box.lo[axis] - point[axis], point[axis] - box.hi[axis]});
    }
    return length(away);
}

} // namespace

double measure_load_per_gravity(const Engine& engine) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    Box held = {{1, 1, 1}, {-1, -1, -1}};
    bool any = false;
    for (std::size_t node = 0; node < mesh.node_home.size(); ++node) {
        if (mesh.node_held[node] == 0) { continue; }
        const Vec3& home = mesh.node_home[node];
        if (!any) { held = {home, home}; }
        any = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            held.lo[axis] = std::min(held.lo[axis], home[axis]);
            held.hi[axis] = std::max(held.hi[axis], home[axis]);
        }
    }
    if (!any) { return 0; }
    double reach = 0;
    for (std::size_t node = 0; node < mesh.node_home.size(); ++node) {
        reach = std::max(reach, distance_from(held, mesh.node_home[node]));
    }
    double softest = 0; // density over Young's modulus, s^2/m^2
    for (const Material& material : engine.tissue.materials) {
        softest = std::max(softest, material.density / material.young);
    }
    return softest * reach;
}

std::vector<std::string> find_warnings(const Engine& engine) {
    std::vector<std::string> warnings;
    const double load_number = engine.tissue.load_per_gravity * length(to_double(engine.constants.gravity));
    if (load_number > (1 + rounding) * trusted_load) {
        warnings.push_back(fmt::format(
            "the load number rho g L / E is {:.2f}: above {:g} elements at necks and thin edges may stay "
            "crushed or turn inside out once the body is cut; take a stiffer material, hold more of the body "
            "or lower gravity",
            load_number, trusted_load));
    }
    if (engine.strain.elements_inverted > 0) {
        warnings.push_back(fmt::format(
            "{} of {} element copies were inside out at the check before step {}: what they show of the "
            "tissue there is not to be trusted; take a stiffer material, a finer mesh or less load",
            engine.strain.elements_inverted, engine.elements.count, engine.step + 1));
    }
    return warnings;
}

} // namespace resect
