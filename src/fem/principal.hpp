// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vec.hpp"
#include "fem/deformation.hpp"

namespace resect {

/// A symmetric 3x3 matrix.
template <class T>
struct Symmetric {
    std::array<T, 3> diagonal;     // 00, 11, 22
    std::array<T, 3> off_diagonal; // 12, 02, 01
};

/// F^T F - 1 of H = F - 1.
template <class T>
Symmetric<T> right_cauchy_green_minus_1(const Matrix3<T>& H) {
    const auto entry = [&](int i, int j) {
        return H.at[i][j] + H.at[j][i] + H.at[0][i] * H.at[0][j] + H.at[1][i] * H.at[1][j] +
               H.at[2][i] * H.at[2][j];
    };
    return {{entry(0, 0), entry(1, 1), entry(2, 2)}, {entry(1, 2), entry(0, 2), entry(0, 1)}};
}

/// Descending. Errors are about 1e-8 of the spread of the eigenvalues.
Vec3 eigenvalues(const Symmetric<double>& A);

/// det F and the principal stretches, descending; the last one has the sign of J.
struct Stretches {
    double J = 1;
    Vec3 value = {1, 1, 1};
};
Stretches principal_stretches(const Matrix3<double>& H);

/// Upper bound of the law's tangent dP/dF as a quadratic form in H, Pa:
///     H : dP/dF : H <= volumetric (cof F : H)^2 + remainder |H|^2.
struct TangentBound {
    double volumetric = 0, remainder = 0;
};
TangentBound bound_tangent(const Stretches& stretches, const Moduli& m);

} // namespace resect
