// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "fem/principal.hpp"
#include "fem/step.hpp"

namespace resect {
namespace {

/// A copy in double precision.
struct CopyState {
    Deformation<double> at = {};
    double gradient[3][3] = {}; // 1/m, of corners 1 to 3
    double volume = 0;          // m^3, weighted
    Moduli moduli = {};
};

CopyState state_of(const Elements& elements, std::span<const Vec3f> displacement, Index copy) {
    const ElementBlock& block = elements.blocks[row(copy / lanes)];
    const Index lane = copy % lanes;
    const Vec3 base = to_double(displacement[row(block.node[0][lane])]);
    CopyState state;
    double relative[3][3] = {};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 u = to_double(displacement[row(block.node[k + 1][lane])]) - base;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            relative[k][axis] = u[axis];
            state.gradient[k][axis] = double(block.gradient[k][axis][lane]);
        }
    }
    state.at = deformation(displacement_gradient(relative, state.gradient));
    state.volume = double(block.volume[lane]);
    state.moduli = {double(block.mu[lane]), double(block.bulk[lane]), double(block.wall[lane])};
    return state;
}

/// sum_i |A grad N_i|^2 over the four corners, 1/m^2.
double sum_of_squares(const Matrix3<double>& A, const double (&gradient)[3][3]) {
    double sum = 0;
    Vec3 first = {};
    for (const auto& g : gradient) {
        const Vec3 image = {A.at[0][0] * g[0] + A.at[0][1] * g[1] + A.at[0][2] * g[2],
                            A.at[1][0] * g[0] + A.at[1][1] * g[1] + A.at[1][2] * g[2],
                            A.at[2][0] * g[0] + A.at[2][1] * g[1] + A.at[2][2] * g[2]};
        sum += dot(image, image);
        first += image;
    }
    return sum + dot(first, first);
}

/// Lower bound of the critical step of an element that is held by nothing, s. With H = sum_i u_i (x) grad N_i
/// both terms of the tangent's bound are at most sums of squares times |u|^2:
///     (cof F : H)^2 <= sum |cof F grad N_i|^2 |u|^2,   |H|^2 <= sum |grad N_i|^2 |u|^2,
/// so with nodal masses rho V / 4 the largest squared frequency is at most 4 / rho times their sum.
double live_bound(const CopyState& state, const Stretches& stretches, double density) {
    const Matrix3<double> identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Matrix3<double> cof = state.at.cof;
    for (int i = 0; i < 3; ++i) {
        cof.at[i][i] += 1;
    }
    // What a wall is raised by is borne by neighbours' mass (sim/stiffness.cpp).
    const TangentBound tangent = bound_tangent(stretches, {state.moduli.mu, state.moduli.bulk});
    const double stiffness = tangent.volumetric * sum_of_squares(cof, state.gradient) +
                             tangent.remainder * sum_of_squares(identity, state.gradient);
    return std::sqrt(density / stiffness); // infinite where nothing resists
}

} // namespace

StrainCheck merge(const StrainCheck& a, const StrainCheck& b) {
    StrainCheck both = b.live_bound < a.live_bound ? b : a;
    both.stretch_min = std::min(a.stretch_min, b.stretch_min);
    both.stretch_max = std::max(a.stretch_max, b.stretch_max);
    both.beyond_range = a.beyond_range + b.beyond_range;
    both.inverted = a.inverted + b.inverted;
    return both;
}

namespace {

/// Displacements of the corners of 16 copies less those of corner 0, m.
struct alignas(64) RelativeBlock {
    float at[3][3][lanes];
};

void gather(RelativeBlock& to, const ElementBlock& block, std::span<const Vec3f> displacement) {
    for (Index lane = 0; lane < lanes; ++lane) {
        const Vec3f& base = displacement[row(block.node[0][lane])];
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f u = displacement[row(block.node[k + 1][lane])] - base;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                to.at[k][axis][lane] = u[axis];
            }
        }
    }
}

struct alignas(64) Suspects {
    int copy[lanes]; // 1: may have left the trusted range or the known stretches
};

/// With E = C - 1 of mean p and deviator d, squared stretches lie within 1 + p -+ sqrt(2/3) |d|.
[[gnu::flatten]] void find_suspects(Suspects& __restrict suspects, const ElementBlock& __restrict block,
                                    const RelativeBlock& __restrict u, float above, float below) {
    constexpr float margin = 1e-4F;
    for (int lane = 0; lane < lanes; ++lane) {
        float relative[3][3], gradient[3][3];
        for (int k = 0; k < 3; ++k) {
            for (int axis = 0; axis < 3; ++axis) {
                relative[k][axis] = u.at[k][axis][lane];
                gradient[k][axis] = block.gradient[k][axis][lane];
            }
        }
        const Matrix3<float> H = displacement_gradient(relative, gradient);
        Invariants<float> now = deformation(H).now;
        now.volume_change -= margin;
        now.length_change += margin;
        now.area_change += margin;
        const Symmetric<float> E = right_cauchy_green_minus_1(H);
        const float sum = E.diagonal[0] + E.diagonal[1] + E.diagonal[2];
        const float squares = dot(E.diagonal, E.diagonal) + 2 * dot(E.off_diagonal, E.off_diagonal);
        const float p = sum * (1.0F / 3);
        const float radius_squared = (squares - sum * p) * (2.0F / 3);
        const float room = above - p < below + p ? above - p : below + p;
        const bool is_known = (room >= 0) & (radius_squared <= room * room);
        suspects.copy[lane] = (is_known & is_trusted(now)) ? 0 : 1;
    }
}

} // namespace

StrainCheck screen_strain(const Elements& elements, const NodeArrays& nodes, const StrainCheck& known,
                          Range copies) {
    RESECT_ASSERT(copies.begin % lanes == 0);
    const auto above = static_cast<float>(known.stretch_max * known.stretch_max - 1);
    const auto below = static_cast<float>(1 - known.stretch_min * std::abs(known.stretch_min));
    StrainCheck check;
    RelativeBlock u = {};
    Suspects suspects = {};
    for (Index first = copies.begin; first < copies.end; first += lanes) {
        const ElementBlock& block = elements.blocks[row(first / lanes)];
        gather(u, block, nodes.displacement);
        find_suspects(suspects, block, u, above, below);
        for (Index copy = first; copy < std::min(first + lanes, copies.end); ++copy) {
            if (suspects.copy[copy % lanes] == 0) { continue; }
            const CopyState state = state_of(elements, nodes.displacement, copy);
            const Stretches now = principal_stretches(state.at.H);
            const bool trusted = is_trusted(state.at.now);
            check = merge(check, {.stretch_min = now.value[2],
                                  .stretch_max = now.value[0],
                                  .beyond_range = trusted ? 0 : 1,
                                  .inverted = now.J <= 0 ? 1 : 0});
        }
    }
    return check;
}

StrainCheck check_strain(const Elements& elements, const NodeArrays& nodes, std::span<const float> density,
                         Range copies) {
    StrainCheck check;
    for (Index copy = copies.begin; copy < copies.end; ++copy) {
        const CopyState state = state_of(elements, nodes.displacement, copy);
        const Stretches now = principal_stretches(state.at.H);
        const bool trusted = is_trusted(state.at.now);
        check = merge(check, {now.value[2], now.value[0], trusted ? 0 : 1, now.J <= 0 ? 1 : 0, copy,
                              live_bound(state, now, double(density[row(copy)]))});
    }
    return check;
}

double elastic_energy(const Elements& elements, std::span<const Vec3f> displacement, Index copy) {
    const CopyState state = state_of(elements, displacement, copy);
    return state.volume * law(state.at.now, state.moduli).W;
}

double elastic_energy(const Elements& elements, std::span<const Vec3f> displacement) {
    double energy = 0;
    for (Index copy = 0; copy < elements.count; ++copy) {
        energy += elastic_energy(elements, displacement, copy);
    }
    return energy;
}

double von_mises_stress(const Elements& elements, const NodeArrays& nodes, Index copy) {
    const CopyState state = state_of(elements, nodes.displacement, copy);
    const Stretches now = principal_stretches(state.at.H);
    // Principal Cauchy stresses but for the pressure dW/dJ, which all three share. A copy crushed below a
    // thousandth of its volume counts as that thousandth.
    const Energy W = law(state.at.now, state.moduli);
    const double I1 = 3 + state.at.now.length_change;
    const double scale = 2 / std::max(std::abs(now.J), 1e-3);
    const auto stress = [&](double l) { return scale * l * l * (W.I1 + W.I2 * (I1 - l * l)); };
    const Vec3 s = {stress(now.value[0]), stress(now.value[1]), stress(now.value[2])};
    const Vec3 difference = {s[0] - s[1], s[1] - s[2], s[2] - s[0]};
    return std::sqrt(dot(difference, difference) / 2);
}

} // namespace resect
