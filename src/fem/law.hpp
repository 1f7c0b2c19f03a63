// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "resect/setup.hpp"

// The material law, W = mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2 with I1 = |F|^2 and J = det F, twice: in float
// for lane loops (no branch, no call, no division) while an element is in the trusted range; and in double,
// with derivatives, everywhere. Beyond the range the law is softened and continued (law.cpp, docs/method.md).
namespace resect {

struct Moduli {
    double mu = 0, bulk = 0; // Pa
    double wall = 3;         // of bulk, that rises against being crushed, below trusted_volume
};

inline Moduli moduli(const Material& material) {
    return {material.young / (2 * (1 + material.poisson)), material.young / (3 * (1 - 2 * material.poisson))};
}

/// Where the law is exactly neo-Hookean.
inline constexpr double trusted_volume = 0.6;  // J, and above
inline constexpr double trusted_length = 10.5; // I1, and below; uniaxial tension at nu 0.35 reaches it at 3.1
inline constexpr double trusted_area = 12;     // I2 = |cof F|^2, and below

/// F as the law sees it, in differences from rest, which float holds to its relative precision where strain
/// is small.
template <class T>
struct Invariants {
    T volume_change; // J - 1
    T length_change; // I1 - 3
    T area_change;   // I2 - 3
};

template <class T>
bool is_trusted(const Invariants<T>& now) {
    return (now.volume_change >= static_cast<T>(trusted_volume - 1)) &
           (now.length_change <= static_cast<T>(trusted_length - 3)) &
           (now.area_change <= static_cast<T>(trusted_area - 3));
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

/// P = a F + b cof F, with a = mu phi and b = mu/2 phi' I1 + K (J - 1), Pa. `net` is a + b, which F and cof
/// F, both I at rest, leave there: it is free of cancellation, and b is net - a.
struct Coefficients {
    float a, net;
};

/// In the trusted range; finite anywhere.
inline Coefficients trusted_law(const Invariants<float>& now, float mu, float bulk) {
    constexpr auto least = static_cast<float>(trusted_volume);
    const float J = 1 + now.volume_change;
    const float r = inverse_cube_root(J > least ? J : least);
    const float phi = r * r;
    // phi + phi' I1 / 2 where phi' = -2/3 phi / J and 1 / J = r^3
    const float rest = phi * (r * r * r) * (now.volume_change - now.length_change * (1.0F / 3));
    return {mu * phi, mu * rest + bulk * now.volume_change};
}

/// W and its derivatives by J, I1 and I2, J/m^3.
struct Energy {
    double W = 0;
    double J = 0, I1 = 0, I2 = 0;
    double d2_jj = 0, d2_ji1 = 0, d2_ji2 = 0, d2_i1i1 = 0, d2_i1i2 = 0, d2_i2i2 = 0;
};

/// Everywhere, inverted states included.
Energy law(const Invariants<double>& now, const Moduli& m);

} // namespace resect
