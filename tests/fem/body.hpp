// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>

#include "fem/step.hpp"
#include "kuhn_block.hpp"

namespace resect {

/// A mesh with what the step needs, one copy an element.
struct TestBody {
    TetMesh mesh;
    Material material;
    std::vector<RestElement> rest;
    Elements elements;
    NodeArrays nodes;
    Packing packing;
};

inline Index node_count(const TestBody& body) { return Index(body.mesh.nodes.size()); }

inline TestBody make_test_body(TetMesh mesh, const Material& material, double viscous_time = 0) {
    TestBody body{std::move(mesh), material, {}, {}, {}, {}};
    body.rest = build_rest(body.mesh);
    const std::size_t count = body.mesh.nodes.size();
    std::vector<double> mass(count, 0.0);
    for (std::size_t e = 0; e < body.rest.size(); ++e) {
        const Tet& tet = body.mesh.tets[e];
        append_copy(body.elements, body.rest[e], material, {viscous_time, 1, tet});
        for (const Index n : tet) {
            mass[row(n)] += material.density * body.rest[e].volume / 4;
        }
    }
    NodeArrays& nodes = body.nodes;
    for (const Vec3& x : body.mesh.nodes) {
        nodes.rest.push_back(to_float(x));
    }
    for (auto* array : {&nodes.displacement, &nodes.velocity, &nodes.next_displacement, &nodes.next_velocity,
                        &nodes.load}) {
        array->assign(count, Vec3f{});
    }
    for (const double m : mass) {
        nodes.mass.push_back(static_cast<float>(m));
        nodes.inverse_mass.push_back(static_cast<float>(1 / m));
    }
    body.packing = build_packing(body.elements, nodes);
    return body;
}

inline double rest_bound(const TestBody& body) {
    double bound = std::numeric_limits<double>::infinity();
    for (const RestElement& rest : body.rest) {
        bound = std::min(bound, rest_step_bound(rest, body.material));
    }
    return bound;
}

inline void hold_where(TestBody& body, const std::function<bool(const Vec3&)>& held) {
    for (std::size_t n = 0; n < body.mesh.nodes.size(); ++n) {
        if (held(body.mesh.nodes[n])) { body.nodes.inverse_mass[n] = 0; }
    }
}

inline void all_forces(TestBody& body) {
    place_all_nodes(body.packing, body.nodes);
    for (Index part = 0; part < Index(body.packing.parts.size()); ++part) {
        element_forces(body.elements, body.nodes, body.packing, part);
    }
}

inline StepSums step(TestBody& body, const StepConstants& constants) {
    all_forces(body);
    const StepSums sums = node_update(body.packing, body.nodes, constants, {0, node_count(body)});
    std::swap(body.nodes.displacement, body.nodes.next_displacement);
    std::swap(body.nodes.velocity, body.nodes.next_velocity);
    return sums;
}

/// Net internal force by node, N.
inline std::vector<Vec3> nodal_forces(const TestBody& body) {
    std::vector<Vec3> force;
    force.reserve(body.mesh.nodes.size());
    for (Index node = 0; node < node_count(body); ++node) {
        force.push_back(to_double(internal_force(body.packing, node)));
    }
    return force;
}

} // namespace resect
