// SPDX-License-Identifier: Apache-2.0
#include "sim/check_setup.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/vec.hpp"

namespace resect {

namespace {

constexpr int threads_at_most = 256;
constexpr double most_gravity = 1e5; // m/s^2

Result<void> check_regions(const Setup& setup) {
    const std::vector<Index>& region = setup.body.region;
    if (region.empty()) { return {}; }
    if (region.size() != setup.body.elements.tets.size()) {
        return Error{fmt::format("body: {} regions for {} elements; give one an element, or none",
                                 region.size(), setup.body.elements.tets.size())};
    }
    for (std::size_t element = 0; element < region.size(); ++element) {
        if (region[element] < 0 || static_cast<std::size_t>(region[element]) >= setup.materials.size()) {
            return Error{fmt::format("body: element {} is of region {}, but there are {} materials", element,
                                     region[element], setup.materials.size())};
        }
    }
    return {};
}

Result<void> check_fixed(const Setup& setup) {
    for (std::size_t at = 0; at < setup.fixed.size(); ++at) {
        const Fixed& fixed = setup.fixed[at];
        if (!fixed.node_set.empty()) {
            const auto set = setup.body.node_sets.find(fixed.node_set);
            if (set == setup.body.node_sets.end()) {
                return Error{fmt::format("fixed {}: the body has no node set '{}'", at, fixed.node_set)};
            }
            const auto outside = [&](Index node) {
                return node < 0 || static_cast<std::size_t>(node) >= setup.body.elements.nodes.size();
            };
            if (std::any_of(set->second.begin(), set->second.end(), outside)) {
                return Error{
                    fmt::format("node set '{}': names nodes that the body does not have", fixed.node_set)};
            }
            continue;
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!(fixed.box.lo[axis] <= fixed.box.hi[axis])) {
                return Error{fmt::format("fixed {}: the box's lo ({:g}) is above its hi ({:g}) on axis {}",
                                         at, fixed.box.lo[axis], fixed.box.hi[axis], axis)};
            }
        }
    }
    return {};
}

Result<void> check_loads(const Setup& setup) {
    for (const auto& [node, force] : setup.loads) {
        if (node < 0 || static_cast<std::size_t>(node) >= setup.body.elements.nodes.size()) {
            return Error{fmt::format("load: node {} is not one of the body's {} nodes", node,
                                     setup.body.elements.nodes.size())};
        }
        if (!(length(force) <= 1e9)) {
            return Error{fmt::format("load on node {}: must be finite, in N", node)};
        }
    }
    return {};
}

Result<void> check_motion(const Setup& setup) {
    const auto check = [&](const std::vector<Vec3>& values, const char* what) -> Result<void> {
        if (values.empty()) { return {}; }
        if (values.size() != setup.body.elements.nodes.size()) {
            return Error{fmt::format("initial {}: {} values for {} nodes", what, values.size(),
                                     setup.body.elements.nodes.size())};
        }
        for (std::size_t node = 0; node < values.size(); ++node) {
            if (!(length(values[node]) <= 1e6)) {
                return Error{fmt::format("initial {} of node {}: must be finite and below 1e6", what, node)};
            }
        }
        return {};
    };
    if (Result<void> checked = check(setup.initial.displacement, "displacement"); !checked) {
        return checked;
    }
    return check(setup.initial.velocity, "velocity");
}

Result<void> check_numbers(const Setup& setup) {
    if (Result<void> checked = check_gravity(setup.gravity); !checked) { return checked; }
    if (setup.cut.refine < 0 || setup.cut.refine > 2) {
        return Error{fmt::format("cut.refine is {}; give 0, 1 or 2", setup.cut.refine)};
    }
    if (!(setup.damping >= 0 && setup.damping <= 1e6)) {
        return Error{fmt::format("damping is {:g}; give 1/s from 0 to 1e6", setup.damping)};
    }
    if (!(setup.time_step >= 0 && setup.time_step <= 1e3)) {
        return Error{
            fmt::format("time_step is {:g}; give seconds, or 0 for the automatic one", setup.time_step)};
    }
    if (setup.threads < 0 || setup.threads > threads_at_most) {
        return Error{
            fmt::format("threads is {}; give 1 to {}, or 0 for one a core", setup.threads, threads_at_most)};
    }
    return {};
}

} // namespace

Result<void> check_material(const Material& material, std::size_t at) {
    const auto wrong = [&](const char* what, double value, const char* mend) {
        return Error{fmt::format("material {}: {} is {:g}; {}", at, what, value, mend)};
    };
    if (!(material.young > 0 && material.young <= 1e12)) {
        return wrong("young", material.young, "give Pa above 0 and up to 1e12");
    }
    if (!(material.poisson > -1 && material.poisson <= 0.4999)) {
        return wrong("poisson", material.poisson, "give a value above -1 and up to 0.4999");
    }
    if (!(material.density > 0 && material.density <= 1e6)) {
        return wrong("density", material.density, "give kg/m^3 above 0 and up to 1e6");
    }
    if (material.viscous_time != automatic && !(material.viscous_time >= 0 && material.viscous_time <= 10)) {
        return wrong("viscous_time", material.viscous_time,
                     "give seconds from 0 to 10, or leave it automatic");
    }
    return {};
}

Result<void> check_gravity(const Vec3& gravity) {
    if (length(gravity) <= most_gravity) { return {}; }
    return Error{fmt::format("gravity ({:g}, {:g}, {:g}): must be finite and below {:g} m/s^2", gravity[0],
                             gravity[1], gravity[2], most_gravity)};
}

Result<void> check_setup(const Setup& setup) {
    if (setup.materials.empty()) { return Error{"materials: there is none; give at least one"}; }
    for (std::size_t at = 0; at < setup.materials.size(); ++at) {
        if (Result<void> checked = check_material(setup.materials[at], at); !checked) { return checked; }
    }
    for (const auto check : {check_regions, check_fixed, check_loads, check_motion, check_numbers}) {
        if (Result<void> checked = check(setup); !checked) { return checked; }
    }
    return {};
}

} // namespace resect
