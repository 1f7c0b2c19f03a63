// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "resect/body.hpp"

// Arithmetic of small vectors. They are std::array, so these operators are found by ordinary look-up inside
// namespace resect only.
namespace resect {

template <class T>
constexpr std::array<T, 3> operator+(const std::array<T, 3>& a, const std::array<T, 3>& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

template <class T>
constexpr std::array<T, 3> operator-(const std::array<T, 3>& a, const std::array<T, 3>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class T>
constexpr std::array<T, 3> operator*(T s, const std::array<T, 3>& a) {
    return {s * a[0], s * a[1], s * a[2]};
}

template <class T>
constexpr std::array<T, 3>& operator+=(std::array<T, 3>& a, const std::array<T, 3>& b) {
    return a = a + b;
}

template <class T>
constexpr T dot(const std::array<T, 3>& a, const std::array<T, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
constexpr std::array<T, 3> cross(const std::array<T, 3>& a, const std::array<T, 3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class T>
T length(const std::array<T, 3>& a) {
    return std::sqrt(dot(a, a));
}

/// The direction of `a`, or zero where it has none.
template <class T>
std::array<T, 3> direction(const std::array<T, 3>& a) {
    const T l = length(a);
    return l > 0 ? (1 / l) * a : std::array<T, 3>{};
}

template <class T>
bool is_finite(const std::array<T, 3>& a) {
    return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

inline Vec3 to_double(const Vec3f& a) { return {double(a[0]), double(a[1]), double(a[2])}; }
inline Vec3f to_float(const Vec3& a) {
    return {static_cast<float>(a[0]), static_cast<float>(a[1]), static_cast<float>(a[2])};
}

inline bool is_inside(const Box& box, const Vec3& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(box.lo[axis] <= p[axis] && p[axis] <= box.hi[axis])) { return false; }
    }
    return true;
}

} // namespace resect
