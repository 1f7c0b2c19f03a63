// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "base/index.hpp"
#include "mesh/tet.hpp"

// Textbook TLED in double precision, written from the paper's equations and for nothing but to be read: it
// judges the product's kernels and shares no code with them.
namespace resect {

using M3 = std::array<std::array<double, 3>, 3>;

inline M3 multiply(const M3& A, const M3& B) {
    M3 C = {};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < 3; ++k) {
                C[i][j] += A[i][k] * B[k][j];
            }
        }
    }
    return C;
}

inline M3 transpose(const M3& A) {
    M3 B = {};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            B[i][j] = A[j][i];
        }
    }
    return B;
}

inline double determinant(const M3& A) { return dot(A[0], cross(A[1], A[2])); }

inline M3 inverse(const M3& A) {
    const double d = 1 / determinant(A);
    return transpose({d * cross(A[1], A[2]), d * cross(A[2], A[0]), d * cross(A[0], A[1])});
}

struct ReferenceBody {
    TetMesh mesh;
    double mu = 0, bulk = 0, density = 0, viscous_time = 0, damping = 0;
    Vec3 gravity = {};
    std::vector<bool> held;
    std::vector<double> weight; // [tet] share of its forces; empty: all
    std::vector<double> mass;
    std::vector<Vec3> u, v; // m, and m/s half a step before
};

inline M3 edges(const std::vector<Vec3>& x, const Tet& tet) { // columns x_k - x_0
    return transpose(
        {x[row(tet[1])] - x[row(tet[0])], x[row(tet[2])] - x[row(tet[0])], x[row(tet[3])] - x[row(tet[0])]});
}

/// Equations 2 to 5: F, C = F^T F, S = mu J^(-2/3) (I - I1/3 C^-1) + K J (J - 1) C^-1, f = V F S dN.
inline std::array<Vec3, 4> reference_element_forces(const M3& rest_edges, const M3& edges_now, double mu,
                                                    double bulk) {
    const M3 G = inverse(rest_edges); // row k: grad N of corner k + 1
    const double volume = determinant(rest_edges) / 6;
    const M3 F = multiply(edges_now, G);
    const M3 C = multiply(transpose(F), F);
    const M3 B = inverse(C);
    const double J = determinant(F);
    const double I1 = C[0][0] + C[1][1] + C[2][2];
    M3 S = {};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            S[i][j] = mu * std::pow(J, -2.0 / 3) * (double(i == j) - I1 / 3 * B[i][j]) +
                      bulk * J * (J - 1) * B[i][j];
        }
    }
    const M3 f = multiply(multiply(F, S), transpose(G)); // column k: corner k + 1
    std::array<Vec3, 4> forces = {};
    for (std::size_t k = 0; k < 3; ++k) {
        forces[k + 1] = volume * Vec3{f[0][k], f[1][k], f[2][k]};
        forces[0] = forces[0] - forces[k + 1];
    }
    return forces;
}

inline void reference_step(ReferenceBody& body, double dt) {
    std::vector<Vec3> now = body.mesh.nodes;
    for (std::size_t n = 0; n < now.size(); ++n) {
        now[n] += body.u[n] + body.viscous_time * body.v[n];
    }
    std::vector<Vec3> force(now.size(), Vec3{});
    for (std::size_t t = 0; t < body.mesh.tets.size(); ++t) {
        const Tet& tet = body.mesh.tets[t];
        const auto forces =
            reference_element_forces(edges(body.mesh.nodes, tet), edges(now, tet), body.mu, body.bulk);
        for (std::size_t k = 0; k < 4; ++k) {
            force[row(tet[k])] += (body.weight.empty() ? 1.0 : body.weight[t]) * forces[k];
        }
    }
    for (std::size_t n = 0; n < now.size(); ++n) {
        if (body.held[n]) { continue; }
        const double half = body.damping * dt / 2;
        const Vec3 push = (-1 / body.mass[n]) * force[n] + body.gravity;
        body.v[n] = ((1 - half) / (1 + half)) * body.v[n] + (dt / (1 + half)) * push;
        body.u[n] += dt * body.v[n];
    }
}

} // namespace resect
