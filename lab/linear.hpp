// SPDX-License-Identifier: Apache-2.0
// The linear models that the paper argues against: small strains, solved three ways.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <optional>

#include "resect/setup.hpp"

#include "lab/mesh_cuts.hpp"

namespace lab {

using Stiffness = Eigen::Matrix<double, 12, 12>; // N/m, of one tet

/// Stiffness of a linear tet (Zienkiewicz and Taylor, The Finite Element Method, vol. 1): V B^T D B.
Stiffness compute_stiffness(const TetMesh& mesh, Index tet, const resect::Material& material);
/// S with K = S S^T, rank 6: S = sqrt(V) B^T L with D = L L^T.
Eigen::Matrix<double, 12, 6> compute_stiffness_factor(const TetMesh& mesh, Index tet,
                                                      const resect::Material& material);

/// A body of linear elasticity, some nodes held, under its own weight.
struct LinearBody {
    TetMesh mesh = {};
    resect::Material material = {};
    std::vector<Index> unknown = {}; // [node] first of its three unknowns, or -1: held
    Index unknowns = 0;
    Vec3 gravity = {};          // m/s^2
    Eigen::VectorXd force = {}; // [unknown] N
};
LinearBody make_linear_body(const TetMesh& mesh, const resect::Material& material, const Box& held,
                            const Vec3& gravity);

/// Takes the weight of a tet off its nodes.
void drop_weight(LinearBody& body, Index tet);

Eigen::SparseMatrix<double> assemble(const LinearBody& body);
/// [node] m, of the unknowns.
std::vector<Vec3> displacements(const LinearBody& body, const Eigen::VectorXd& u);

/// Conjugate gradients with a diagonal preconditioner from the start `u` (Nienhuys and van der Stappen).
struct Solution {
    Eigen::VectorXd u = {}; // [unknown] m
    Index iterations = 0;
    bool converged = false;
};
Solution solve_by_conjugate_gradients(const Eigen::SparseMatrix<double>& stiffness,
                                      const Eigen::VectorXd& force, const Eigen::VectorXd& start,
                                      double tolerance = 1e-6);

/// The inverse of the stiffness, precomputed, and updated for each tet that is removed by the
/// Sherman-Morrison-Woodbury formula (Zhong et al.): (K - S S^T)^-1 = A + A S (I - S^T A S)^-1 S^T A.
class PrecomputedInverse {
public:
    explicit PrecomputedInverse(const LinearBody& body);

    /// False, and nothing done, where a part of the body would come free: I - S^T A S is singular then.
    bool remove(Index tet);
    Eigen::VectorXd solve(const Eigen::VectorXd& force) const { return inverse_ * force; }
    /// The force with which a held instrument at `node` must push to move it by `displacement`, N: of
    /// the 3 x 3 block of the inverse (Popescu et al.).
    Vec3 reaction(Index node, const Vec3& displacement) const;

private:
    const LinearBody& body_;
    Eigen::MatrixXd inverse_ = {};
};

/// Tensors of vertices and edges, explicit steps with damping (Cotin, Delingette and Ayache 2000): a tet is
/// removed by taking its tensors away.
class TensorMass {
public:
    TensorMass(const LinearBody& body, double damping); // 1/s

    void remove(Index tet);
    double stable_step() const; // s, by the largest frequency (power iteration) and the damping
    void step(double time_step);
    const Eigen::VectorXd& u() const { return u_; }
    /// Largest speed, m/s.
    double speed() const { return v_.cwiseAbs().maxCoeff(); }

private:
    const LinearBody& body_;
    Eigen::SparseMatrix<double> tensors_ = {};
    Eigen::VectorXd mass_ = {}, u_ = {}, v_ = {};
    double damping_ = 0;
};

} // namespace lab
