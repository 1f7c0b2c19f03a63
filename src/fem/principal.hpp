// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vec.hpp"
#include "fem/deformation.hpp"

namespace resect {

/// A symmetric 3x3 matrix.
struct Symmetric {
    Vec3 diagonal;     // 00, 11, 22
    Vec3 off_diagonal; // 12, 02, 01
};

/// Descending. Errors are about 1e-8 of the spread of the eigenvalues.
Vec3 eigenvalues(const Symmetric& A);

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
