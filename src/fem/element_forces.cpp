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

template <class T>
struct Corners {
    T relative[3][3]; // m, u + viscous_time v of corners 1 to 3 less that of corner 0
    T gradient[3][3]; // 1/m
};

template <class T>
Corners<T> corners_of(const ElementBlock& block, const CornerBlock& u, const CornerBlock& v, int lane) {
    Corners<T> to = {};
    for (int k = 0; k < 3; ++k) {
        for (int axis = 0; axis < 3; ++axis) {
            const float displacement = u.at[k + 1][axis][lane] - u.at[0][axis][lane];
            const float velocity = v.at[k + 1][axis][lane] - v.at[0][axis][lane];
            to.relative[k][axis] = static_cast<T>(displacement + block.viscous_time[lane] * velocity);
            to.gradient[k][axis] = static_cast<T>(block.gradient[k][axis][lane]);
        }
    }
    return to;
}

/// f_k = V P grad N_k; the four forces of an element are in balance.
template <class T>
void put_forces(ForceBlock& out, const Matrix3<T>& P, const Corners<T>& corners, T volume, int lane) {
    for (int axis = 0; axis < 3; ++axis) {
        float others = 0;
        for (int k = 0; k < 3; ++k) {
            const auto& g = corners.gradient[k];
            const auto force = static_cast<float>(
                volume * (P.at[axis][0] * g[0] + P.at[axis][1] * g[1] + P.at[axis][2] * g[2]));
            out.force[k + 1][axis][lane] = force;
            others += force;
        }
        out.force[0][axis][lane] = -others;
    }
}

/// Copies that left the trusted range, 1 each.
struct alignas(64) Beyond {
    Index copy[lanes];
};

/// Equations 2 to 5 of the paper for a linear tet: f_k = V P grad N_k with P = F S. The law is evaluated at
/// u + viscous_time v, which adds strain-rate viscosity of that time constant to first order.
[[gnu::flatten]] void trusted_forces(ForceBlock& __restrict out, Beyond& __restrict beyond,
                                     const ElementBlock& __restrict block, const CornerBlock& __restrict u,
                                     const CornerBlock& __restrict v) {
    for (int lane = 0; lane < lanes; ++lane) {
        const Corners<float> corners = corners_of<float>(block, u, v, lane);
        const Deformation<float> at = deformation(displacement_gradient(corners.relative, corners.gradient));
        const Coefficients law = trusted_law(at.now, block.mu[lane], block.bulk[lane]);
        put_forces(out, trusted_stress(at, law), corners, block.volume[lane], lane);
        beyond.copy[lane] = is_trusted(at.now) ? 0 : 1;
    }
}

/// The same for one copy by the whole law.
void forces_beyond_range(ForceBlock& out, const ElementBlock& block, const CornerBlock& u,
                         const CornerBlock& v, int lane) {
    const Corners<double> corners = corners_of<double>(block, u, v, lane);
    const Deformation<double> at = deformation(displacement_gradient(corners.relative, corners.gradient));
    const Energy energy =
        law(at.now, {double(block.mu[lane]), double(block.bulk[lane]), double(block.wall[lane])});
    put_forces(out, stress(at, energy), corners, double(block.volume[lane]), lane);
}

} // namespace

void element_forces(Elements& elements, const NodeArrays& nodes, Range blocks) {
    CornerBlock u = {};
    CornerBlock v = {};
    Beyond beyond = {};
    for (Index b = blocks.begin; b < blocks.end; ++b) {
        const ElementBlock& block = elements.blocks[row(b)];
        gather(u, block, nodes.displacement);
        gather(v, block, nodes.velocity);
        ForceBlock& out = elements.forces[row(b)];
        trusted_forces(out, beyond, block, u, v);
        for (int lane = 0; lane < lanes; ++lane) {
            if (beyond.copy[lane] != 0) { forces_beyond_range(out, block, u, v, lane); }
        }
    }
}

} // namespace resect
