// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "fem/deformation.hpp"
#include "reference.hpp"

using namespace resect;

namespace {

const Moduli tissue = moduli(Material{});

Matrix3<double> random_matrix(std::mt19937& engine, double size) {
    std::normal_distribution<double> normal(0, size);
    Matrix3<double> H;
    for (auto& line : H.at) {
        for (double& entry : line) {
            entry = normal(engine);
        }
    }
    return H;
}

double energy_of(const Matrix3<double>& H) {
    const Invariants<double> now = invariants(H, cofactors(H));
    return energy_density(now.J_minus_1, now.I1_minus_3, tissue);
}

Matrix3<double> stress_of(const Matrix3<double>& H) {
    const Matrix3<double> cof = cofactors(H);
    const Invariants<double> now = invariants(H, cof);
    return stress(H, cof, law_coefficients(now.J_minus_1, now.I1_minus_3, tissue.mu, tissue.bulk));
}

/// H with det(I + H) = J.
Matrix3<double> with_volume(Matrix3<double> H, double J) {
    const double now = 1 + invariants(H, cofactors(H)).J_minus_1;
    for (int j = 0; j < 3; ++j) {
        H.at[0][j] = (H.at[0][j] + (j == 0 ? 1 : 0)) * (J / now) - (j == 0 ? 1 : 0);
    }
    return H;
}

/// Largest difference of the stress from the central difference of the energy, over the largest stress.
double gradient_error(const Matrix3<double>& H) {
    const Matrix3<double> P = stress_of(H);
    double largest = 0;
    double error = 0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const double h = 1e-5;
            Matrix3<double> up = H;
            Matrix3<double> down = H;
            up.at[i][j] += h;
            down.at[i][j] -= h;
            error = std::max(error, std::abs((energy_of(up) - energy_of(down)) / (2 * h) - P.at[i][j]));
            largest = std::max(largest, std::abs(P.at[i][j]));
        }
    }
    return error / largest;
}

} // namespace

TEST_CASE("the inverse cube root of a float is good to 1e-7 over its whole range") {
    double worst = 0;
    for (float x = 1e-37F; x < 1e38F; x *= 1.0009F) {
        worst = std::max(worst, std::abs(double(inverse_cube_root(x)) * std::cbrt(double(x)) - 1));
    }
    CHECK(worst < 1.2e-7);
    CHECK(double(inverse_cube_root(1.0F)) == doctest::Approx(1).epsilon(1e-7));
}

TEST_CASE("the law is continuous up to its second derivative where it is continued") {
    const Isochoric<double> above = isochoric(continued_below);
    const Isochoric<double> below = continued(continued_below);
    CHECK(below.value == doctest::Approx(above.value).epsilon(1e-14));
    CHECK(below.slope == doctest::Approx(above.slope).epsilon(1e-14));
    CHECK(below.curvature == doctest::Approx(above.curvature).epsilon(1e-14));
}

TEST_CASE("each derivative of the law is the slope of the one before it") {
    for (const double J : {-2.0, -0.1, 0.0, 0.1, 0.29, 0.31, 1.0, 3.0}) {
        const double h = 1e-6;
        const Isochoric<double> up = isochoric(J + h);
        const Isochoric<double> down = isochoric(J - h);
        const Isochoric<double> now = isochoric(J);
        CHECK((up.value - down.value) / (2 * h) == doctest::Approx(now.slope).epsilon(1e-7));
        CHECK((up.slope - down.slope) / (2 * h) == doctest::Approx(now.curvature).epsilon(1e-7));
    }
}

TEST_CASE("stress is the gradient of energy in the trusted range, at its end and beyond it") {
    std::mt19937 engine(1);
    for (const double J : {2.0, 1.0, 0.5, 0.30001, 0.3, 0.29999, 0.2, 0.01, 0.0, -0.01, -0.5, -2.0}) {
        CAPTURE(J);
        for (int i = 0; i < 20; ++i) {
            CHECK(gradient_error(with_volume(random_matrix(engine, 0.3), J)) < 1e-6);
        }
    }
}

TEST_CASE("the law in float is that in double to float precision, relative to the strain") {
    std::mt19937 engine(2);
    for (const double size : {1e-6, 1e-4, 1e-2, 0.1, 1.0}) {
        CAPTURE(size);
        for (int i = 0; i < 50; ++i) {
            const Matrix3<double> H = random_matrix(engine, size);
            const Matrix3<double> P = stress_of(H);
            Matrix3<float> single;
            for (int k = 0; k < 9; ++k) {
                single.at[k / 3][k % 3] = float(H.at[k / 3][k % 3]);
            }
            const Matrix3<float> cof = cofactors(single);
            const Invariants<float> now = invariants(single, cof);
            const Matrix3<float> P_single =
                stress(single, cof,
                       law_coefficients(now.J_minus_1, now.I1_minus_3, float(tissue.mu), float(tissue.bulk)));
            double scale = 0;
            double error = 0;
            for (int k = 0; k < 9; ++k) {
                scale = std::max(scale, std::abs(P.at[k / 3][k % 3]));
                error = std::max(error, std::abs(double(P_single.at[k / 3][k % 3]) - P.at[k / 3][k % 3]));
            }
            CHECK(error < 2e-6 * scale);
        }
    }
}

TEST_CASE("stress equals the textbook's F S") {
    std::mt19937 engine(3);
    for (int i = 0; i < 100; ++i) {
        const Matrix3<double> H = with_volume(random_matrix(engine, 0.3), 0.4 + 0.02 * i);
        const Matrix3<double> P = stress_of(H);
        const M3 unit = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        M3 F = {};
        for (std::size_t k = 0; k < 9; ++k) {
            F[k / 3][k % 3] = unit[k / 3][k % 3] + H.at[k / 3][k % 3];
        }
        const auto forces = reference_element_forces(unit, F, tissue.mu, tissue.bulk);
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                CHECK(6 * forces[k + 1][axis] == doctest::Approx(P.at[axis][k]).epsilon(1e-10).scale(1e4));
            }
        }
    }
}

TEST_CASE("uniaxial tension follows the closed form") {
    // With lateral stretch q the lateral stress mu phi (q^2 - l^2) / (3 q) + K (J - 1) l q vanishes, J = l
    // q^2, and the axial stress is 2/3 mu phi (l^2 - q^2) / l + K (J - 1) q^2.
    for (const double l : {0.6, 0.9, 1.0, 1.1, 1.5, 2.5}) {
        double low = 0.3;
        double high = 2;
        const auto lateral = [&](double q) {
            const double J = l * q * q;
            return tissue.mu * std::pow(J, -2.0 / 3) * (q * q - l * l) / (3 * q) +
                   tissue.bulk * (J - 1) * l * q;
        };
        for (int i = 0; i < 100; ++i) {
            const double middle = (low + high) / 2;
            (lateral(middle) > 0 ? high : low) = middle;
        }
        const double q = low;
        const double J = l * q * q;
        const Matrix3<double> P = stress_of({{{l - 1, 0, 0}, {0, q - 1, 0}, {0, 0, q - 1}}});
        const double axial =
            2.0 / 3 * tissue.mu * std::pow(J, -2.0 / 3) * (l * l - q * q) / l + tissue.bulk * (J - 1) * q * q;
        CHECK(P.at[0][0] == doctest::Approx(axial).epsilon(1e-10).scale(1));
        CHECK(P.at[1][1] == doctest::Approx(0).scale(1e3).epsilon(1e-10));
    }
}
