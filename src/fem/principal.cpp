// SPDX-License-Identifier: Apache-2.0
#include "fem/principal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace resect {
namespace {

double determinant(const Symmetric<double>& A) {
    const auto& [d, o] = A;
    return d[0] * (d[1] * d[2] - o[0] * o[0]) - o[2] * (o[2] * d[2] - o[0] * o[1]) +
           o[1] * (o[2] * o[0] - d[1] * o[1]);
}

} // namespace

// The trigonometric solution of the characteristic cubic of A, shifted and scaled.
Vec3 eigenvalues(const Symmetric<double>& A) {
    const auto& [d, o] = A;
    const double mean = (d[0] + d[1] + d[2]) / 3;
    const Vec3 shifted = d - Vec3{mean, mean, mean};
    const double scale = std::sqrt((dot(shifted, shifted) + 2 * dot(o, o)) / 6);
    if (!(scale > 0)) { return {mean, mean, mean}; }
    const Symmetric<double> unit = {(1 / scale) * shifted, (1 / scale) * o};
    const double angle = std::acos(std::clamp(determinant(unit) / 2, -1.0, 1.0)) / 3;
    const double first = 2 * std::cos(angle);
    const double last = 2 * std::cos(angle + 2 * std::numbers::pi / 3);
    return {mean + scale * first, mean - scale * (first + last), mean + scale * last};
}

Stretches principal_stretches(const Matrix3<double>& H) {
    const Vec3 squares_minus_1 = eigenvalues(right_cauchy_green_minus_1(H));
    const double J = 1 + deformation(H).now.volume_change;
    const double first = std::sqrt(std::max(0.0, 1 + squares_minus_1[0]));
    const double second = std::sqrt(std::max(0.0, 1 + squares_minus_1[1]));
    // J knows a small third stretch better than C does, and its sign.
    const double area = first * second;
    const double third = area > 0 ? std::clamp(J / area, -second, second) : 0;
    return {J, {first, second, third}};
}

// In principal axes F = diag(l), n = cof F = diag(dJ/dl_i), and W is a function of l. The tangent is then the
// Hessian of W on the diagonal of H, and on each pair (H_ij, H_ji) it has the eigenvalues
//     (W_i +- W_j) / (l_i +- l_j) = 2 dW/dI1 +- dW/dJ l_k + 2 dW/dI2 (l_k^2 +- l_i l_j).
// Any share of n (x) n may be split off before the largest eigenvalue of what remains is taken; the share
// below leaves 2 mu at rest, where the bound is K - 2/3 mu and 2 mu, the exact split of the linear law. It is
// the part along n of the terms in d2W/dJ2, d2W/dJ dI1 and dW/dJ (within 2 % of the best share in random
// states).
TangentBound bound_tangent(const Stretches& stretches, const Moduli& m) {
    const Vec3& l = stretches.value;
    const Vec3 n = {l[1] * l[2], l[0] * l[2], l[0] * l[1]};
    const double I1 = dot(l, l);
    const double n2 = dot(n, n);
    const Energy W = law({stretches.J - 1, I1 - 3, n2 - 3}, m);
    const double along = 12 * W.d2_ji1 * stretches.J / n2 + 3 * W.J * stretches.J * I1 / (n2 * n2);
    const double share = n2 > 0 ? std::max(0.0, W.d2_jj + along) : 0.0;

    // Gradients of J, I1 and I2 by l are n, 2 l and q.
    const Vec3 q = {2 * l[0] * (I1 - l[0] * l[0]), 2 * l[1] * (I1 - l[1] * l[1]),
                    2 * l[2] * (I1 - l[2] * l[2])};
    const auto curvature = [&](std::size_t i, std::size_t j) {
        return (W.d2_jj - share) * n[i] * n[j] + 2 * W.d2_ji1 * (n[i] * l[j] + l[i] * n[j]) +
               W.d2_ji2 * (n[i] * q[j] + q[i] * n[j]) + 4 * W.d2_i1i1 * l[i] * l[j] +
               2 * W.d2_i1i2 * (l[i] * q[j] + q[i] * l[j]) + W.d2_i2i2 * q[i] * q[j];
    };
    const auto on = [&](std::size_t i) { return curvature(i, i) + 2 * W.I1 + 2 * W.I2 * (I1 - l[i] * l[i]); };
    const auto off = [&](std::size_t i, std::size_t j, std::size_t k) {
        return curvature(i, j) + W.J * l[k] + 4 * W.I2 * l[i] * l[j];
    };
    const auto pair = [&](std::size_t i, std::size_t j, std::size_t k) {
        return 2 * W.I1 + 2 * W.I2 * l[k] * l[k] + std::abs(W.J * l[k] + 2 * W.I2 * l[i] * l[j]);
    };
    const Symmetric<double> hessian = {{on(0), on(1), on(2)}, {off(1, 2, 0), off(0, 2, 1), off(0, 1, 2)}};
    const double pairs = std::max({0.0, pair(1, 2, 0), pair(0, 2, 1), pair(0, 1, 2)});
    return {share, std::max(eigenvalues(hessian)[0], pairs)};
}

} // namespace resect
