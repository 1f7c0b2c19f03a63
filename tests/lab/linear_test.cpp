// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "base/index.hpp"
#include "base/vec.hpp"
#include "lab/linear.hpp"
#include "mesh/tet.hpp"

using namespace resect;
using namespace lab;

namespace {

const Material tissue = {.young = 2e4, .poisson = 0.3, .density = 1000};
const Vec3 gravity = {0, 0, -9.81};
const Box left = {{-1, -1, -1}, {0, 1, 1}};

LinearBody hang_small_block() {
    return make_linear_body(make_jittered_block({0.1, 0.1, 0.1}, {3, 3, 3}, 0.2, 1), tissue, left, gravity);
}

Eigen::VectorXd solve_directly(const LinearBody& body) {
    return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(assemble(body)).solve(body.force);
}

/// The body without some tets, on the same nodes.
LinearBody without(const LinearBody& body, const std::vector<Index>& gone) {
    TetMesh mesh = body.mesh;
    for (auto tet = gone.rbegin(); tet != gone.rend(); ++tet) {
        mesh.tets.erase(mesh.tets.begin() + *tet);
    }
    return make_linear_body(mesh, tissue, left, gravity);
}

double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return (a - b).norm() / b.norm(); }

} // namespace

TEST_CASE("a tet's stiffness has the energy of a constant strain, in closed form, and no other modes") {
    const TetMesh mesh = make_jittered_block({0.1, 0.1, 0.1}, {1, 1, 1}, 0, 1);
    const Stiffness k = compute_stiffness(mesh, 2, tissue);
    CHECK((k - k.transpose()).norm() < 1e-12 * k.norm());
    const auto factor = compute_stiffness_factor(mesh, 2, tissue);
    CHECK((factor * factor.transpose() - k).norm() < 1e-12 * k.norm());
    Eigen::Matrix3d gradient;
    gradient << 0.01, 0.004, -0.002, 0.001, -0.006, 0.003, 0.005, 0.002, 0.008;
    Eigen::Matrix<double, 12, 1> u;
    for (int corner = 0; corner < 4; ++corner) {
        const Vec3& p = mesh.nodes[row(mesh.tets[2][row(corner)])];
        u.segment<3>(3 * corner) = gradient * Eigen::Vector3d(p[0], p[1], p[2]);
    }
    const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
    const double lambda = tissue.young * tissue.poisson / ((1 + tissue.poisson) * (1 - 2 * tissue.poisson));
    const double mu = tissue.young / (2 * (1 + tissue.poisson));
    const double energy = signed_volume(mesh, mesh.tets[2]) *
                          (0.5 * lambda * strain.trace() * strain.trace() + mu * strain.squaredNorm());
    CHECK(0.5 * u.dot(k * u) == doctest::Approx(energy).epsilon(1e-12));
    const Eigen::SelfAdjointEigenSolver<Stiffness> spectrum(k);
    CHECK(std::abs(spectrum.eigenvalues()[5]) < 1e-10 * spectrum.eigenvalues()[11]);
    CHECK(spectrum.eigenvalues()[6] > 1e-3 * spectrum.eigenvalues()[11]);
}

TEST_CASE("conjugate gradients and damped tensor-mass steps come to the direct solution") {
    const LinearBody body = hang_small_block();
    const Eigen::VectorXd exact = solve_directly(body);
    const Solution solution =
        solve_by_conjugate_gradients(assemble(body), body.force, Eigen::VectorXd::Zero(body.unknowns), 1e-10);
    CHECK(solution.converged);
    CHECK(difference(solution.u, exact) < 1e-8);
    TensorMass springs(body, 60);
    const double step = 0.9 * springs.stable_step();
    for (int i = 0; i < 20000; ++i) {
        springs.step(step);
    }
    CHECK(springs.speed() < 1e-9);
    CHECK(difference(springs.u(), exact) < 1e-8);
    TensorMass unstable(body, 0);
    for (int i = 0; i < 500; ++i) {
        unstable.step(1.1 / 0.9 * step);
    }
    CHECK_FALSE(unstable.u().norm() < 1e3 * exact.norm());
}

TEST_CASE("the updated inverse is that of the body without the tets, and of tensors too") {
    const LinearBody whole = hang_small_block();
    LinearBody body = whole;
    const std::vector<Index> gone = {40, 41, 47, 90};
    PrecomputedInverse inverse(body);
    TensorMass springs(body, 60);
    for (const Index tet : gone) {
        REQUIRE(inverse.remove(tet));
        springs.remove(tet);
        drop_weight(body, tet);
    }
    const Eigen::VectorXd exact = solve_directly(without(whole, gone));
    CHECK(difference(solve_directly(whole), exact) > 1e-3);
    CHECK(difference(inverse.solve(body.force), exact) < 1e-9);
    const double step = 0.9 * springs.stable_step();
    for (int i = 0; i < 20000; ++i) {
        springs.step(step);
    }
    CHECK(difference(springs.u(), exact) < 1e-7);
}

TEST_CASE("no tet is taken out of the inverse that would set a piece free") {
    const LinearBody body = hang_small_block();
    PrecomputedInverse inverse(body);
    const Sheet plane = flat_notch({0.05, 0, 0.2}, {0.05, 0, -0.1}, 0.1);
    int refused = 0;
    for (const Index tet : find_crossed(body.mesh, plane)) {
        refused += inverse.remove(tet) ? 0 : 1;
    }
    CHECK(refused > 0);
    CHECK(inverse.solve(body.force).allFinite());
}

TEST_CASE("the reaction moves the node by as much as was asked") {
    const LinearBody body = hang_small_block();
    const Index node = 63; // the corner farthest from the wall
    const Vec3 asked = {0.002, -0.001, 0.003};
    const Vec3 force = PrecomputedInverse(body).reaction(node, asked);
    LinearBody pushed = body;
    pushed.force.setZero();
    const Index at = body.unknown[row(node)];
    pushed.force.segment<3>(at) << force[0], force[1], force[2];
    const Eigen::VectorXd u = solve_directly(pushed);
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(u[at + axis] == doctest::Approx(asked[row(axis)]).epsilon(1e-9));
    }
}
