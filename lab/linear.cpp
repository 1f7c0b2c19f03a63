// SPDX-License-Identifier: Apache-2.0
#include "lab/linear.hpp"

#include <cmath>

#include "base/index.hpp"
#include "base/vec.hpp"
#include "mesh/tet.hpp"

namespace lab {

using namespace resect;

namespace {

/// Smaller than this, an eigenvalue of I - S^T A S is one of a part that comes free.
constexpr double least_hold = 1e-7;

/// [column: corner] Gradients of the shape functions, 1/m.
Eigen::Matrix<double, 3, 4> compute_gradients(const TetMesh& mesh, const Tet& tet) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) {
        const Vec3 edge = mesh.nodes[row(tet[row(k + 1)])] - mesh.nodes[row(tet[0])];
        edges.row(k) = Eigen::Vector3d(edge[0], edge[1], edge[2]);
    }
    Eigen::Matrix<double, 3, 4> gradients;
    gradients.rightCols<3>() = edges.inverse();
    gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
    return gradients;
}

/// Strains xx, yy, zz, xy, yz, zx (shear doubled) by the twelve displacements.
Eigen::Matrix<double, 6, 12> compute_strain_matrix(const TetMesh& mesh, const Tet& tet) {
    const Eigen::Matrix<double, 3, 4> gradients = compute_gradients(mesh, tet);
    Eigen::Matrix<double, 6, 12> b = Eigen::Matrix<double, 6, 12>::Zero();
    for (int k = 0; k < 4; ++k) {
        const Eigen::Vector3d g = gradients.col(k);
        b.block<6, 3>(0, Eigen::Index{3} * k) << g[0], 0, 0, 0, g[1], 0, 0, 0, g[2], g[1], g[0], 0, 0, g[2],
            g[1], g[2], 0, g[0];
    }
    return b;
}

Eigen::Matrix<double, 6, 6> compute_elasticity(const Material& material) {
    const double nu = material.poisson;
    const double lambda = material.young * nu / ((1 + nu) * (1 - 2 * nu));
    const double mu = material.young / (2 * (1 + nu));
    Eigen::Matrix<double, 6, 6> d = Eigen::Matrix<double, 6, 6>::Zero();
    d.topLeftCorner<3, 3>().setConstant(lambda);
    d.diagonal() << lambda + 2 * mu, lambda + 2 * mu, lambda + 2 * mu, mu, mu, mu;
    return d;
}

/// Calls visit(i, j, unknown i, unknown j) for the free degrees of freedom of a tet.
template <class Visit>
void for_each_entry(const LinearBody& body, Index tet, const Visit& visit) {
    const Tet& nodes = body.mesh.tets[row(tet)];
    for (int i = 0; i < 12; ++i) {
        const Index at_i = body.unknown[row(nodes[row(i / 3)])];
        for (int j = 0; j < 12 && at_i >= 0; ++j) {
            const Index at_j = body.unknown[row(nodes[row(j / 3)])];
            if (at_j >= 0) { visit(i, j, at_i + i % 3, at_j + j % 3); }
        }
    }
}

void add_weight(LinearBody& body, Index tet, double times) {
    const Tet& nodes = body.mesh.tets[row(tet)];
    const double share = times * body.material.density * signed_volume(body.mesh, nodes) / 4;
    for (const Index node : nodes) {
        const Index at = body.unknown[row(node)];
        for (int axis = 0; axis < 3 && at >= 0; ++axis) {
            body.force[at + axis] += share * body.gravity[row(axis)];
        }
    }
}

} // namespace

Stiffness compute_stiffness(const TetMesh& mesh, Index tet, const Material& material) {
    const Tet& nodes = mesh.tets[row(tet)];
    const Eigen::Matrix<double, 6, 12> b = compute_strain_matrix(mesh, nodes);
    return signed_volume(mesh, nodes) * b.transpose() * compute_elasticity(material) * b;
}

Eigen::Matrix<double, 12, 6> compute_stiffness_factor(const TetMesh& mesh, Index tet,
                                                      const Material& material) {
    const Tet& nodes = mesh.tets[row(tet)];
    const Eigen::Matrix<double, 6, 6> root = compute_elasticity(material).llt().matrixL();
    return std::sqrt(signed_volume(mesh, nodes)) * compute_strain_matrix(mesh, nodes).transpose() * root;
}

LinearBody make_linear_body(const TetMesh& mesh, const Material& material, const Box& held,
                            const Vec3& gravity) {
    LinearBody body{.mesh = mesh, .material = material, .gravity = gravity};
    for (const Vec3& node : mesh.nodes) {
        body.unknown.push_back(is_inside(held, node) ? -1 : body.unknowns);
        if (body.unknown.back() >= 0) { body.unknowns += 3; }
    }
    body.force = Eigen::VectorXd::Zero(body.unknowns);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        add_weight(body, static_cast<Index>(t), 1);
    }
    return body;
}

void drop_weight(LinearBody& body, Index tet) { add_weight(body, tet, -1); }

Eigen::SparseMatrix<double> assemble(const LinearBody& body) {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t t = 0; t < body.mesh.tets.size(); ++t) {
        const auto tet = static_cast<Index>(t);
        const Stiffness k = compute_stiffness(body.mesh, tet, body.material);
        for_each_entry(body, tet, [&](int i, int j, Index at_i, Index at_j) {
            entries.emplace_back(at_i, at_j, k(i, j));
        });
    }
    Eigen::SparseMatrix<double> stiffness(body.unknowns, body.unknowns);
    stiffness.setFromTriplets(entries.begin(), entries.end());
    return stiffness;
}

std::vector<Vec3> displacements(const LinearBody& body, const Eigen::VectorXd& u) {
    std::vector<Vec3> of_nodes;
    for (const Index at : body.unknown) {
        of_nodes.push_back(at < 0 ? Vec3{} : Vec3{u[at], u[at + 1], u[at + 2]});
    }
    return of_nodes;
}

Solution solve_by_conjugate_gradients(const Eigen::SparseMatrix<double>& stiffness,
                                      const Eigen::VectorXd& force, const Eigen::VectorXd& start,
                                      double tolerance) {
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(tolerance);
    solver.compute(stiffness);
    Solution solution;
    solution.u = solver.solveWithGuess(force, start);
    solution.iterations = static_cast<Index>(solver.iterations());
    solution.converged = solver.info() == Eigen::Success && solution.u.allFinite();
    return solution;
}

PrecomputedInverse::PrecomputedInverse(const LinearBody& body) : body_(body) {
    const Eigen::MatrixXd stiffness = assemble(body);
    inverse_ = stiffness.llt().solve(Eigen::MatrixXd::Identity(body.unknowns, body.unknowns));
}

bool PrecomputedInverse::remove(Index tet) {
    const Eigen::Matrix<double, 12, 6> factor = compute_stiffness_factor(body_.mesh, tet, body_.material);
    std::vector<Index> at; // unknowns
    std::vector<int> of;   // rows of the factor
    for (int i = 0; i < 12; ++i) {
        const Index first = body_.unknown[row(body_.mesh.tets[row(tet)][row(i / 3)])];
        if (first < 0) { continue; }
        at.push_back(first + i % 3);
        of.push_back(i);
    }
    const Eigen::MatrixXd s = factor(of, Eigen::all);
    const Eigen::MatrixXd a_s = inverse_(Eigen::all, at) * s;
    const Eigen::Matrix<double, 6, 6> core =
        Eigen::Matrix<double, 6, 6>::Identity() - s.transpose() * a_s(at, Eigen::all);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> spectrum(core);
    if (!(spectrum.eigenvalues()[0] > least_hold)) { return false; }
    inverse_.noalias() += a_s * core.inverse() * a_s.transpose();
    return true;
}

Vec3 PrecomputedInverse::reaction(Index node, const Vec3& displacement) const {
    const Index at = body_.unknown[row(node)];
    const Eigen::Vector3d force = inverse_.block<3, 3>(at, at).ldlt().solve(
        Eigen::Vector3d(displacement[0], displacement[1], displacement[2]));
    return {force[0], force[1], force[2]};
}

TensorMass::TensorMass(const LinearBody& body, double damping)
    : body_(body), tensors_(assemble(body)), mass_(Eigen::VectorXd::Zero(body.unknowns)),
      u_(Eigen::VectorXd::Zero(body.unknowns)), v_(u_), damping_(damping) {
    for (const Tet& tet : body.mesh.tets) {
        for (const Index node : tet) {
            const Index at = body.unknown[row(node)];
            if (at >= 0) {
                mass_.segment<3>(at).array() += body.material.density * signed_volume(body.mesh, tet) / 4;
            }
        }
    }
}

void TensorMass::remove(Index tet) {
    const Stiffness k = compute_stiffness(body_.mesh, tet, body_.material);
    for_each_entry(body_, tet,
                   [&](int i, int j, Index at_i, Index at_j) { tensors_.coeffRef(at_i, at_j) -= k(i, j); });
}

double TensorMass::stable_step() const {
    constexpr int iterations = 200;
    Eigen::VectorXd mode = Eigen::VectorXd::LinSpaced(mass_.size(), -1, 2);
    double square = 0; // 1/s^2
    for (int i = 0; i < iterations; ++i) {
        mode = (tensors_ * mode).cwiseQuotient(mass_).eval();
        square = mode.norm();
        mode /= square;
    }
    return 2 / std::sqrt(square);
}

void TensorMass::step(double time_step) {
    const Eigen::VectorXd acceleration = (body_.force - tensors_ * u_).cwiseQuotient(mass_);
    v_ =
        ((1 - 0.5 * damping_ * time_step) * v_ + time_step * acceleration) / (1 + 0.5 * damping_ * time_step);
    u_ += time_step * v_;
}

} // namespace lab
