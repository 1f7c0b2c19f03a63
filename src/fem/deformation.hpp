// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fem/law.hpp"

// Deformation and stress of a linear tet, for lane loops in float and for checks in double. Everything is
// written in the displacement gradient H = F - I: F, J and I1 are never formed, so that float keeps its
// relative precision where displacements are small.
namespace resect {

template <class T>
struct Matrix3 {
    T at[3][3]; // [row][column]
};

/// H = sum_k (u_k - u_0) (x) grad N_k over corners 1 to 3.
template <class T>
Matrix3<T> displacement_gradient(const T (&relative)[3][3], const T (&gradient)[3][3]) {
    Matrix3<T> H;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            H.at[i][j] = relative[0][i] * gradient[0][j] + relative[1][i] * gradient[1][j] +
                         relative[2][i] * gradient[2][j];
        }
    }
    return H;
}

/// d det A / dA.
template <class T>
Matrix3<T> cofactors(const Matrix3<T>& A) {
    const auto& a = A.at;
    return {{{a[1][1] * a[2][2] - a[1][2] * a[2][1], a[1][2] * a[2][0] - a[1][0] * a[2][2],
              a[1][0] * a[2][1] - a[1][1] * a[2][0]},
             {a[2][1] * a[0][2] - a[2][2] * a[0][1], a[2][2] * a[0][0] - a[2][0] * a[0][2],
              a[2][0] * a[0][1] - a[2][1] * a[0][0]},
             {a[0][1] * a[1][2] - a[0][2] * a[1][1], a[0][2] * a[1][0] - a[0][0] * a[1][2],
              a[0][0] * a[1][1] - a[0][1] * a[1][0]}}};
}

template <class T>
T trace(const Matrix3<T>& A) {
    return A.at[0][0] + A.at[1][1] + A.at[2][2];
}

template <class T>
struct Invariants {
    T J_minus_1, I1_minus_3;
};

/// det(I + H) - 1 = tr H + tr cof H + det H and |I + H|^2 - 3 = 2 tr H + |H|^2.
template <class T>
Invariants<T> invariants(const Matrix3<T>& H, const Matrix3<T>& cof) {
    const auto& h = H.at;
    const auto& c = cof.at;
    const T determinant = h[0][0] * c[0][0] + h[0][1] * c[0][1] + h[0][2] * c[0][2];
    const T square = h[0][0] * h[0][0] + h[0][1] * h[0][1] + h[0][2] * h[0][2] + h[1][0] * h[1][0] +
                     h[1][1] * h[1][1] + h[1][2] * h[1][2] + h[2][0] * h[2][0] + h[2][1] * h[2][1] +
                     h[2][2] * h[2][2];
    return {trace(H) + (trace(cof) + determinant), 2 * trace(H) + square};
}

/// First Piola-Kirchhoff stress P = F S = a F + b cof F, Pa, with cof F = I + tr(H) I - H^T + cof H.
template <class T>
Matrix3<T> stress(const Matrix3<T>& H, const Matrix3<T>& cof, const Coefficients<T>& law) {
    const T b = law.net - law.a;
    const T on_diagonal = law.net + b * trace(H);
    Matrix3<T> P;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            P.at[i][j] = law.a * H.at[i][j] + b * (cof.at[i][j] - H.at[j][i]);
            if (i == j) { P.at[i][j] += on_diagonal; }
        }
    }
    return P;
}

} // namespace resect
