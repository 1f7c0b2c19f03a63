// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "base/index.hpp"
#include "base/vec.hpp"

namespace resect::fuzz {

/// Draws from a seed, the same on every platform.
class Random {
public:
    explicit Random(std::uint64_t seed) : bits_(seed) {}

    double draw(double low, double high) {
        return low + (high - low) * 0x1p-53 * static_cast<double>(bits_() >> 11U);
    }
    bool chance(double share) { return draw(0, 1) < share; }
    /// Of low to high, both included.
    Index pick(Index low, Index high) {
        return low + static_cast<Index>(bits_() % (std::uint64_t{row(high - low)} + 1));
    }
    Vec3 draw_vector(double low, double high) {
        const double x = draw(low, high);
        const double y = draw(low, high);
        return {x, y, draw(low, high)};
    }
    Vec3 draw_direction() {
        for (;;) {
            const Vec3 v = draw_vector(-1, 1);
            const double l = length(v);
            if (l > 0.1 && l <= 1) { return (1 / l) * v; }
        }
    }

private:
    std::mt19937_64 bits_;
};

/// The seed of number `index` of a family of cases (splitmix64).
inline std::uint64_t derive_seed(std::uint64_t base, std::uint64_t family, std::uint64_t index) {
    std::uint64_t z = base + 0x9E3779B97F4A7C15U * (1 + index) + 0xD1B54A32D192ED03U * family;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
}

} // namespace resect::fuzz
