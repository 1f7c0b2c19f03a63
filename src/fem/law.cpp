// SPDX-License-Identifier: Apache-2.0
#include "fem/law.hpp"

#include <algorithm>
#include <cmath>

// What an explicit step does not survive is a tangent that stiffens without end: the terms mu/2 phi'' I1 |cof
// F|^2 and K |cof F|^2 of an element that is stretched several times and squashed flat. So beyond the trusted
// range
//
//   W = mu/2 (I1 - 3 + (phi(J') - 1) g(I1)) + U(J'),   J' = 1 + (J - 1) k(I2)
//
// where k takes |cof F| out, g takes I1 out, and phi goes on below trusted_volume with a curvature that
// fades, while U grows a cubic and then quadratic wall that pushes inverted elements back. Widths and the
// wall's height were found by trial (docs/method.md).
namespace resect {
namespace {

constexpr double softening_width = 0.3; // of a threshold
constexpr double fade_width = 0.4;      // in J', of the curvature of phi

/// A function of one argument with its first and second derivative.
struct Curve {
    double value, slope, curvature;
};

/// phi - 1: J^(-2/3), then a cubic whose curvature falls to zero over fade_width, then its tangent.
Curve isochoric_minus_1(double change) {
    constexpr double J0 = trusted_volume;
    if (1 + change >= J0) {
        const double excess = std::expm1(std::log1p(change) * (-2.0 / 3));
        const double slope = -2.0 / 3 * (1 + excess) / (1 + change);
        return {excess, slope, -5.0 / 3 * slope / (1 + change)};
    }
    const double phi0 = 1 / std::cbrt(J0 * J0);
    const double slope0 = -2.0 / 3 * phi0 / J0;
    const double curvature0 = 10.0 / 9 * phi0 / (J0 * J0);
    const double d = 1 + change - J0;
    const double in = std::max(d, -fade_width); // the cubic's share
    const double slope = slope0 + curvature0 * in * (1 + in / (2 * fade_width));
    const double value =
        phi0 - 1 + in * (slope0 + curvature0 * in * (0.5 + in / (6 * fade_width))) + slope * (d - in);
    return {value, slope, d < in ? 0 : curvature0 * (1 + in / fade_width)};
}

/// U / K: (J' - 1)^2 / 2 and the wall below trusted_volume, a cubic and then a parabola; what the wall is
/// raised by is a parabola at once, which pushes most for the tangent that it takes.
Curve volumetric(double change, double wall) {
    constexpr double J0 = trusted_volume;
    constexpr double common = Moduli{}.wall;
    const double m = std::max(0.0, J0 - 1 - change);
    const double in = std::min(m, J0); // the cubic's share; the rest lies below J' = 0
    const double out = m - in;
    const double raised = wall - common;
    return {change * change / 2 + common * (in * in * in / (6 * J0) + in * out / 2 + out * out / 2) +
                raised * m * m / 2,
            change - common * (in * in / (2 * J0) + out) - raised * m,
            1 + common * in / J0 + (m > 0 ? raised : 0)};
}

/// k: 1 up to trusted_area, then falling like I2^(-1/2).
Curve area_softening(double area_change) {
    constexpr double width = softening_width * trusted_area;
    const double e = (area_change - (trusted_area - 3)) / width;
    if (!(e > 0)) { return {1, 0, 0}; }
    const double r = 1 / (1 + e * e);
    const double k = std::sqrt(std::sqrt(r));
    return {k, -e / (2 * width) * r * k, (-0.5 + 1.25 * e * e * r) * r * k / (width * width)};
}

/// g: I1 up to trusted_length, then levelling off.
Curve length_softening(double length_change) {
    constexpr double width = softening_width * trusted_length;
    const double d = std::max(0.0, length_change - (trusted_length - 3));
    const double q = 1 / std::sqrt(1 + d * d / (width * width));
    return {3 + length_change - d + d * q, q * q * q, -3 * d * q * q * q * q * q / (width * width)};
}

} // namespace

Energy law(const Invariants<double>& now, const Moduli& m) {
    const double change = now.volume_change;
    const Curve k = area_softening(now.area_change);
    const Curve g = length_softening(now.length_change);
    const Curve phi = isochoric_minus_1(change * k.value);
    const Curve U = volumetric(change * k.value, m.wall);
    const double half = m.mu / 2;
    const double p = half * phi.slope * g.value + m.bulk * U.slope; // dW / dJ'
    const double pp = half * phi.curvature * g.value + m.bulk * U.curvature;
    const double by_j = k.value; // dJ' / dJ
    const double by_i2 = change * k.slope;
    Energy energy;
    energy.W = half * (now.length_change + phi.value * g.value) + m.bulk * U.value;
    energy.J = p * by_j;
    energy.I1 = half * (1 + phi.value * g.slope);
    energy.I2 = p * by_i2;
    energy.d2_jj = pp * by_j * by_j;
    energy.d2_ji1 = half * phi.slope * g.slope * by_j;
    energy.d2_ji2 = pp * by_j * by_i2 + p * k.slope;
    energy.d2_i1i1 = half * phi.value * g.curvature;
    energy.d2_i1i2 = half * phi.slope * g.slope * by_i2;
    energy.d2_i2i2 = pp * by_i2 * by_i2 + p * change * k.curvature;
    return energy;
}

} // namespace resect
