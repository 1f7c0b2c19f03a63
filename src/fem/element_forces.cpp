// SPDX-License-Identifier: Apache-2.0
#include "base/index.hpp"
#include "fem/deformation.hpp"
#include "fem/step.hpp"

namespace resect {
namespace {

/// Corner values of 16 copies.
struct alignas(64) CornerBlock {
    float at[4][3][lanes];
};

void gather(CornerBlock& to, const ElementBlock& block, const std::vector<Vec3f>& values) {
    for (Index corner = 0; corner < 4; ++corner) {
        for (Index lane = 0; lane < lanes; ++lane) {
            const Vec3f& value = values[row(block.node[corner][lane])];
            to.at[corner][0][lane] = value[0];
            to.at[corner][1][lane] = value[1];
            to.at[corner][2][lane] = value[2];
        }
    }
}

/// Equations 2 to 5 of the paper for a linear tet: f_k = V P grad N_k with P = F S. The law is evaluated at
/// u + viscous_time v, which adds strain-rate viscosity of that time constant to first order.
[[gnu::flatten]] void block_forces(ForceBlock& __restrict out, const ElementBlock& __restrict block,
                                   const CornerBlock& __restrict u, const CornerBlock& __restrict v) {
    for (int lane = 0; lane < lanes; ++lane) {
        float relative[3][3];
        float gradient[3][3];
        for (int k = 0; k < 3; ++k) {
            for (int axis = 0; axis < 3; ++axis) {
                relative[k][axis] =
                    (u.at[k + 1][axis][lane] - u.at[0][axis][lane]) +
                    block.viscous_time[lane] * (v.at[k + 1][axis][lane] - v.at[0][axis][lane]);
                gradient[k][axis] = block.gradient[k][axis][lane];
            }
        }
        const Matrix3<float> H = displacement_gradient(relative, gradient);
        const Matrix3<float> cof = cofactors(H);
        const Invariants<float> now = invariants(H, cof);
        const Coefficients<float> law =
            law_coefficients(now.J_minus_1, now.I1_minus_3, block.mu[lane], block.bulk[lane]);
        const Matrix3<float> P = stress(H, cof, law);
        for (int axis = 0; axis < 3; ++axis) {
            float others = 0;
            for (int k = 0; k < 3; ++k) {
                const float force =
                    block.volume[lane] * (P.at[axis][0] * gradient[k][0] + P.at[axis][1] * gradient[k][1] +
                                          P.at[axis][2] * gradient[k][2]);
                out.force[k + 1][axis][lane] = force;
                others += force;
            }
            out.force[0][axis][lane] = -others; // the four forces of an element are in balance
        }
    }
}

} // namespace

void element_forces(Elements& elements, const NodeArrays& nodes, Range blocks) {
    CornerBlock u;
    CornerBlock v;
    for (Index b = blocks.begin; b < blocks.end; ++b) {
        const ElementBlock& block = elements.blocks[row(b)];
        gather(u, block, nodes.displacement);
        gather(v, block, nodes.velocity);
        block_forces(elements.forces[row(b)], block, u, v);
    }
}

} // namespace resect
