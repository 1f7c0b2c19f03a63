// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fem/law.hpp"

// Deformation and stress of a linear tet, for lane loops in float and for checks in double. Everything is
// written in the displacement gradient H = F - I, and float never forms F, J or I1, so that it keeps its
// relative precision where displacements are small.
namespace resect {

template <class T>
struct Matrix3 {
    T at[3][3]; // [row][column]
};

/// H = sum_k (u_k - u_0) (x) grad N_k over corners 1 to 3.
template <class T>
Matrix3<T> displacement_gradient(const T (&relative)[3][3], const T (&gradient)[3][3]) {
    Matrix3<T> H = {};
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

/// cof(I + H) - I = tr(H) I - H^T + cof H.
template <class T>
Matrix3<T> cofactor_change(const Matrix3<T>& H, const Matrix3<T>& cof) {
    Matrix3<T> D = {};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            D.at[i][j] = cof.at[i][j] - H.at[j][i];
        }
        D.at[i][i] += trace(H);
    }
    return D;
}

/// |I + A|^2 - 3.
template <class T>
T square_change(const Matrix3<T>& A) {
    const auto& a = A.at;
    return 2 * trace(A) + (a[0][0] * a[0][0] + a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][0] * a[1][0] +
                           a[1][1] * a[1][1] + a[1][2] * a[1][2] + a[2][0] * a[2][0] + a[2][1] * a[2][1] +
                           a[2][2] * a[2][2]);
}

/// H with what the law and the stress need of it.
template <class T>
struct Deformation {
    Matrix3<T> H = {};
    Matrix3<T> cof = {}; // cof F - I
    Invariants<T> now = {};
};

/// det(I + H) - 1 = tr H + tr cof H + det H.
template <class T>
Deformation<T> deformation(const Matrix3<T>& H) {
    const Matrix3<T> C = cofactors(H);
    const Matrix3<T> D = cofactor_change(H, C);
    const T determinant = H.at[0][0] * C.at[0][0] + H.at[0][1] * C.at[0][1] + H.at[0][2] * C.at[0][2];
    return {H, D, {trace(H) + (trace(C) + determinant), square_change(H), square_change(D)}};
}

/// First Piola-Kirchhoff stress P = F S = a F + b cof F, Pa, in the trusted range.
inline Matrix3<float> trusted_stress(const Deformation<float>& at, const Coefficients& law) {
    const float b = law.net - law.a;
    Matrix3<float> P = {};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            P.at[i][j] = law.a * at.H.at[i][j] + b * at.cof.at[i][j];
        }
        P.at[i][i] += law.net;
    }
    return P;
}

/// The same anywhere: P = dW/dJ cof F + 2 dW/dI1 F + 2 dW/dI2 (I1 F - F F^T F).
inline Matrix3<double> stress(const Deformation<double>& at, const Energy& energy) {
    Matrix3<double> F = at.H;
    for (int i = 0; i < 3; ++i) {
        F.at[i][i] += 1;
    }
    const double along_f = 2 * energy.I1 + 2 * energy.I2 * (3 + at.now.length_change);
    Matrix3<double> P = {};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            double cubic = 0;
            for (int k = 0; k < 3; ++k) {
                const double along =
                    F.at[i][0] * F.at[k][0] + F.at[i][1] * F.at[k][1] + F.at[i][2] * F.at[k][2];
                cubic += along * F.at[k][j];
            }
            P.at[i][j] = along_f * F.at[i][j] + energy.J * at.cof.at[i][j] - 2 * energy.I2 * cubic;
        }
        P.at[i][i] += energy.J;
    }
    return P;
}

} // namespace resect
