// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "body.hpp"
#include "fem/law.hpp"
#include "reference.hpp"

using namespace resect;

namespace {

ReferenceBody make_reference(const TestBody& body, const StepConstants& constants, double viscous_time) {
    ReferenceBody reference;
    reference.mesh = body.mesh;
    reference.mu = moduli(body.material).mu;
    reference.bulk = moduli(body.material).bulk;
    reference.density = body.material.density;
    reference.viscous_time = viscous_time;
    reference.damping = double(constants.damping);
    reference.gravity = to_double(constants.gravity);
    reference.u.assign(body.mesh.nodes.size(), Vec3{});
    reference.v = reference.u;
    reference.mass.assign(body.mesh.nodes.size(), 0.0);
    for (const Tet& tet : body.mesh.tets) {
        for (const Index n : tet) {
            reference.mass[row(n)] += reference.density * signed_volume(body.mesh, tet) / 4;
        }
    }
    for (const float inverse_mass : body.nodes.inverse_mass) {
        reference.held.push_back(inverse_mass == 0);
    }
    return reference;
}

/// Largest difference of displacement over the largest displacement after 200 steps of a cantilever.
double error_after_200_steps(double viscous_share, float damping) {
    TestBody probe = make_test_body(kuhn_block({0.1, 0.1, 0.1}, {10, 10, 10}), Material{});
    const double bound = rest_bound(probe);
    TestBody body = make_test_body(probe.mesh, Material{}, viscous_share * bound);
    hold_where(body, [](const Vec3& x) { return x[0] == 0; });
    // At 0.35 of the bound 200 steps end while every element is still in the trusted range.
    const StepConstants constants{float(0.35 * bound), damping, {0, 0, -9.81F}};
    ReferenceBody reference = make_reference(body, constants, viscous_share * bound);
    for (int i = 0; i < 200; ++i) {
        step(body, constants);
        reference_step(reference, double(constants.time_step));
    }
    const std::vector<float> density(row(body.elements.count), 1000.0F);
    const StrainCheck strain = check_strain(body.elements, body.nodes, density, {0, body.elements.count});
    CHECK(strain.beyond_range == 0);
    double largest = 0;
    double error = 0;
    for (std::size_t n = 0; n < reference.u.size(); ++n) {
        largest = std::max(largest, length(reference.u[n]));
        error = std::max(error, length(to_double(body.nodes.displacement[n]) - reference.u[n]));
    }
    MESSAGE("largest displacement ", largest, " m, relative error ", error / largest);
    CHECK(largest > 0.02);
    return error / largest;
}

} // namespace

TEST_CASE("200 steps of large bending agree with the textbook in double precision") {
    CHECK(error_after_200_steps(0, 0) < 1e-5);
}

TEST_CASE("200 steps with both kinds of damping agree with the textbook in double precision") {
    CHECK(error_after_200_steps(0.1, 2) < 1e-5);
}
