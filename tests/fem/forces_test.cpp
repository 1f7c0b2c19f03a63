// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <doctest/doctest.h>
#include <random>

#include "body.hpp"
#include "fem/deformation.hpp"
#include "fem/law.hpp"

using namespace resect;

namespace {

TestBody make_block(double viscous_time = 0) {
    return make_test_body(kuhn_block({0.03, 0.04, 0.05}, {3, 4, 5}), Material{}, viscous_time);
}

void shake(TestBody& body, double size, unsigned seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal(0, size);
    for (Vec3f& u : body.nodes.displacement) {
        u = to_float({normal(engine), normal(engine), normal(engine)});
    }
    for (Vec3f& v : body.nodes.velocity) {
        v = to_float({normal(engine), normal(engine), normal(engine)});
    }
}

/// u = A x + b at every node.
void deform(TestBody& body, const std::array<Vec3, 3>& A, const Vec3& b) {
    for (std::size_t n = 0; n < body.mesh.nodes.size(); ++n) {
        const Vec3& x = body.mesh.nodes[n];
        body.nodes.displacement[n] = to_float(Vec3{dot(A[0], x), dot(A[1], x), dot(A[2], x)} + b);
    }
}

/// The forces of a copy's corners by the whole law in double precision, N.
std::array<Vec3, 4> forces_of(const TestBody& body, Index copy) {
    const Tet tet = corners(body.elements, copy);
    const RestElement& rest = body.rest[row(copy)];
    double relative[3][3] = {}, gradient[3][3] = {};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 u = to_double(body.nodes.displacement[row(tet[k + 1])]) -
                       to_double(body.nodes.displacement[row(tet[0])]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            relative[k][axis] = u[axis];
            gradient[k][axis] = rest.gradient[k + 1][axis];
        }
    }
    const Deformation<double> at = deformation(displacement_gradient(relative, gradient));
    const Matrix3<double> P = stress(at, law(at.now, moduli(body.material)));
    std::array<Vec3, 4> force = {};
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const Vec3& g = rest.gradient[corner];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            force[corner][axis] = rest.volume * dot(Vec3{P.at[axis][0], P.at[axis][1], P.at[axis][2]}, g);
        }
    }
    return force;
}

/// Sum of the sizes of the forces that meet in a node, N.
std::vector<double> magnitudes(const TestBody& body) {
    std::vector<double> sum(body.mesh.nodes.size(), 0.0);
    for (Index copy = 0; copy < body.elements.count; ++copy) {
        const std::array<Vec3, 4> force = forces_of(body, copy);
        for (std::size_t corner = 0; corner < 4; ++corner) {
            sum[row(corners(body.elements, copy)[corner])] += length(force[corner]);
        }
    }
    return sum;
}

bool is_same(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)) == 0;
}

} // namespace

namespace {

/// dW/du of one coordinate by central differences, N.
double energy_slope(TestBody& body, std::size_t node, std::size_t axis) {
    float& u = body.nodes.displacement[node][axis];
    const float before = u;
    const float up = before + 1e-5F;
    const float down = before - 1e-5F;
    u = up;
    const double above = elastic_energy(body.elements, body.nodes.displacement);
    u = down;
    const double below = elastic_energy(body.elements, body.nodes.displacement);
    u = before;
    return (above - below) / (double(up) - double(down));
}

/// Largest difference of nodal forces from the slope of the energy, over the forces that meet in the node.
double gradient_error(double shake_size) {
    TestBody body = make_block();
    shake(body, shake_size, 4);
    all_forces(body);
    const std::vector<Vec3> force = nodal_forces(body);
    const std::vector<double> scale = magnitudes(body);
    double error = 0;
    for (const std::size_t n : {std::size_t{0}, std::size_t{50}, std::size_t{119}}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            error = std::max(error, std::abs(energy_slope(body, n, axis) - force[n][axis]) / scale[n]);
        }
    }
    return error;
}

} // namespace

TEST_CASE("what nodes resist with is the gradient of the elastic energy, inverted elements included") {
    for (const double size : {5e-4, 3e-3, 8e-3}) { // of cells of 1e-2 m: small, crushed, inverted
        CAPTURE(size);
        CHECK(gradient_error(size) < 2e-5);
    }
}

TEST_CASE("an affine deformation leaves no net force inside and the same stress everywhere") {
    TestBody body = make_block();
    deform(body, {{{0.2, 0.1, -0.05}, {0.3, -0.1, 0.1}, {0.0, 0.2, 0.15}}}, {0.1, 0.2, 0.3});
    all_forces(body);
    const std::vector<Vec3> force = nodal_forces(body);
    const std::vector<double> scale = magnitudes(body);
    const auto inside = [&](const Vec3& x) {
        return is_inside({{0.001, 0.001, 0.001}, {0.029, 0.039, 0.049}}, x);
    };
    double error = 0;
    for (std::size_t n = 0; n < force.size(); ++n) {
        if (inside(body.mesh.nodes[n])) { error = std::max(error, length(force[n]) / scale[n]); }
    }
    CHECK(error < 4e-5); // coordinates of 0.3 m round by 1.5e-6 of a cell
    const double expected = von_mises_stress(body.elements, body.nodes, 0);
    CHECK(expected > 100);
    for (Index copy = 1; copy < body.elements.count; ++copy) {
        CHECK(von_mises_stress(body.elements, body.nodes, copy) == doctest::Approx(expected).epsilon(1e-4));
    }
}

TEST_CASE("von Mises stress of a uniaxial strain is the difference of the principal Cauchy stresses") {
    TestBody body = make_block();
    deform(body, {{{0.5, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, {});
    const double mu = body.material.young / (2 * (1 + body.material.poisson));
    CHECK(von_mises_stress(body.elements, body.nodes, 7) ==
          doctest::Approx(mu * std::pow(1.5, -5.0 / 3) * (1.5 * 1.5 - 1)).epsilon(1e-5));
}

TEST_CASE("forces turn with a rigid rotation") {
    TestBody body = make_block();
    shake(body, 1e-3, 5);
    TestBody turned = body;
    const double c = std::cos(1.1);
    const double s = std::sin(1.1);
    const auto turn = [&](const Vec3& x) { return Vec3{c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]}; };
    for (std::size_t n = 0; n < body.mesh.nodes.size(); ++n) {
        const Vec3& x = body.mesh.nodes[n];
        turned.nodes.displacement[n] = to_float(turn(x + to_double(body.nodes.displacement[n])) - x);
    }
    all_forces(body);
    all_forces(turned);
    const std::vector<Vec3> force = nodal_forces(body);
    const std::vector<Vec3> turned_force = nodal_forces(turned);
    const std::vector<double> scale = magnitudes(body);
    for (std::size_t n = 0; n < force.size(); ++n) {
        CHECK(length(turn(force[n]) - turned_force[n]) < 1e-4 * scale[n]);
    }
}

TEST_CASE("a translation or a motion without strain makes no force but rounding") {
    TestBody body = make_block(1e-4);
    deform(body, {}, {0.25, -0.5, 0.125});
    for (Vec3f& v : body.nodes.velocity) {
        v = {1, 2, -3};
    }
    all_forces(body);
    // The scale is that of a strain of 1.
    const Moduli m = moduli(body.material);
    const double scale = (m.bulk + m.mu) * 1e-2 * 1e-2;
    for (const Vec3& force : nodal_forces(body)) {
        CHECK(length(force) < 1e-6 * scale);
    }
}

TEST_CASE("internal forces sum to zero") {
    TestBody body = make_block(1e-4);
    shake(body, 2e-3, 6);
    all_forces(body);
    Vec3 sum = {};
    double total = 0;
    for (const Vec3& force : nodal_forces(body)) {
        sum += force;
        total += length(force);
    }
    CHECK(length(sum) < 1e-7 * total);
}

TEST_CASE("viscous forces resist the rate of strain and take energy") {
    TestBody body = make_block(1e-3);
    std::mt19937 engine(9);
    std::normal_distribution<double> normal(0, 1e-3);
    for (Vec3f& v : body.nodes.velocity) {
        v = to_float({normal(engine), normal(engine), normal(engine)});
    }
    all_forces(body);
    double power = 0;
    const std::vector<Vec3> force = nodal_forces(body);
    for (std::size_t n = 0; n < force.size(); ++n) {
        power += dot(force[n], to_double(body.nodes.velocity[n]));
    }
    CHECK(power > 0);
}

TEST_CASE("the forces of every copy are those of the whole law in double precision") {
    for (const double size : {1e-4, 3e-3, 8e-3, 0.5}) { // of cells of 1e-2 m: small, crushed, inverted, torn
        CAPTURE(size);
        TestBody body = make_block();
        shake(body, size, 7);
        for (Vec3f& v : body.nodes.velocity) {
            v = {};
        }
        all_forces(body);
        std::vector<Vec3> expected(body.mesh.nodes.size(), Vec3{});
        for (Index copy = 0; copy < body.elements.count; ++copy) {
            const std::array<Vec3, 4> force = forces_of(body, copy);
            for (std::size_t corner = 0; corner < 4; ++corner) {
                expected[row(corners(body.elements, copy)[corner])] += force[corner];
            }
        }
        const std::vector<Vec3> force = nodal_forces(body);
        const std::vector<double> scale = magnitudes(body);
        double error = 0;
        for (std::size_t n = 0; n < force.size(); ++n) {
            error = std::max(error, length(force[n] - expected[n]) / scale[n]);
        }
        MESSAGE("relative error ", error);
        CHECK(error < (size < 1e-3 ? 2e-4 : 5e-6));
    }
}

TEST_CASE("a step has the same bits however its ranges are split") {
    TestBody whole = make_block(1e-4);
    shake(whole, 1e-3, 8);
    TestBody parts = whole;
    const StepConstants constants{1e-4F, 1, {0, 0, -9.81F}};
    const Index nodes = node_count(whole);
    const StepSums sums = step(whole, constants);
    all_forces(parts);
    const StepSums second = node_update(parts.packing, parts.nodes, constants, {nodes / 3, nodes});
    const StepSums first = node_update(parts.packing, parts.nodes, constants, {0, nodes / 3});
    CHECK(is_same(whole.nodes.displacement, parts.nodes.next_displacement));
    CHECK(is_same(whole.nodes.velocity, parts.nodes.next_velocity));
    CHECK(sums.speed_squared == (first + second).speed_squared);
    CHECK(sums.internal_work == doctest::Approx((first + second).internal_work).epsilon(1e-5));
}
