// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "resect/setup.hpp"

#include "base/vec.hpp"

// The material law as pure functions of scalars, for lane loops in float (no branch, no call, no division)
// and for checks in double:
//
//   W = mu/2 (phi(J) I1 - 3) + K/2 (J - 1)^2,   phi = J^(-2/3),   I1 = tr C = |F|^2
//   P = dW/dF = a F + b cof F,   a = mu phi,   b = mu/2 phi' I1 + K (J - 1)
namespace resect {

struct Moduli {
    double mu = 0, bulk = 0; // Pa
};

inline Moduli moduli(const Material& material) {
    return {material.young / (2 * (1 + material.poisson)), material.young / (3 * (1 - 2 * material.poisson))};
}

/// Below this J, phi goes on as a parabola that meets J^(-2/3) with its first and second derivative, so that
/// crushed and inverted elements have finite energy and are pushed back (docs/method.md).
inline constexpr double continued_below = 0.3;

template <class T>
struct Isochoric {
    T value, slope, curvature; // phi, d phi / dJ, d2 phi / dJ2
};

/// phi below continued_below. With `isochoric` the only place that knows how the law is continued.
template <class T>
Isochoric<T> continued(T J) {
    constexpr double J0 = continued_below;
    constexpr double phi0 = 2.231443166940565; // J0^(-2/3)
    constexpr T value = static_cast<T>(phi0);
    constexpr T slope = static_cast<T>(-2 * phi0 / (3 * J0));
    constexpr T curvature = static_cast<T>(10 * phi0 / (9 * J0 * J0));
    const T d = J - static_cast<T>(J0);
    return {value + d * (slope + d * (curvature / 2)), slope + d * curvature, curvature};
}

inline Isochoric<double> isochoric(double J) {
    if (J < continued_below) { return continued(J); }
    const double phi = 1 / std::cbrt(J * J);
    return {phi, -2 * phi / (3 * J), 10 * phi / (9 * J * J)};
}

/// x^(-1/3) for finite positive x, relative error below 1e-7. The exponent is divided by three in the bits of
/// the number; two steps of Halley's kind (cubic convergence) do the rest.
inline float inverse_cube_root(float x) {
    constexpr float bits_of_start = 1419887104.0F;
    const auto bits = static_cast<float>(std::bit_cast<std::int32_t>(x));
    float y = std::bit_cast<float>(static_cast<std::int32_t>(bits_of_start - bits * (1.0F / 3)));
    for (int step = 0; step < 2; ++step) {
        const float error = 1 - x * y * y * y;
        y += y * error * (1.0F / 3 + error * (2.0F / 9));
    }
    return y;
}

inline double inverse_cube_root(double x) { return 1 / std::cbrt(x); }

template <class T>
struct Coefficients {
    T a;   // Pa, of F
    T net; // Pa, a + b: what F and cof F, which are both I at rest, leave there; b = net - a
};

/// Of P, from J - 1 and I1 - 3, which float holds to its relative precision near a state without strain where
/// J and I1 would not; `net` is then free of cancellation too.
template <class T>
Coefficients<T> law_coefficients(T J_minus_1, T I1_minus_3, T mu, T bulk) {
    constexpr T J0 = static_cast<T>(continued_below);
    const T J = 1 + J_minus_1;
    const T r = inverse_cube_root(J > J0 ? J : J0);
    const T phi = r * r;
    // phi + phi' I1 / 2 where phi' = -2/3 phi / J and 1 / J = r^3
    const T rest = phi * (r * r * r) * (J_minus_1 - I1_minus_3 * (T(1) / 3));
    const Isochoric<T> below = continued(J);
    const T below_rest = below.value + below.slope * (3 + I1_minus_3) * (T(1) / 2);
    const bool trusted = J >= J0;
    return {mu * (trusted ? phi : below.value), mu * (trusted ? rest : below_rest) + bulk * J_minus_1};
}

/// W, J per m^3; phi I1 - 3 is formed from small differences as above.
inline double energy_density(double J_minus_1, double I1_minus_3, const Moduli& m) {
    const double J = 1 + J_minus_1;
    const double phi_minus_1 = J < continued_below ? continued(J).value - 1 //
                                                   : std::expm1(std::log1p(J_minus_1) * (-2.0 / 3));
    return m.mu / 2 * (I1_minus_3 + phi_minus_1 * (3 + I1_minus_3)) + m.bulk / 2 * J_minus_1 * J_minus_1;
}

} // namespace resect
