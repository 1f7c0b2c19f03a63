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
    Matrix3<double> H = {};
    for (auto& line : H.at) {
        for (double& entry : line) {
            entry = normal(engine);
        }
    }
    return H;
}

double energy_of(const Matrix3<double>& H) { return law(deformation(H).now, tissue).W; }

Matrix3<double> stress_of(const Matrix3<double>& H) {
    const Deformation<double> at = deformation(H);
    return stress(at, law(at.now, tissue));
}

/// The largest difference of entries, and the largest entry of `A`.
struct Difference {
    double error = 0, scale = 0;
};
template <class T>
Difference compare(const Matrix3<double>& A, const Matrix3<T>& B) {
    Difference found;
    for (int k = 0; k < 9; ++k) {
        const double a = A.at[k / 3][k % 3];
        found.scale = std::max(found.scale, std::abs(a));
        found.error = std::max(found.error, std::abs(double(B.at[k / 3][k % 3]) - a));
    }
    return found;
}

/// H with det(I + H) = J.
Matrix3<double> with_volume(Matrix3<double> H, double J) {
    const double now = 1 + deformation(H).now.volume_change;
    for (int j = 0; j < 3; ++j) {
        H.at[0][j] = (H.at[0][j] + (j == 0 ? 1 : 0)) * (J / now) - (j == 0 ? 1 : 0);
    }
    return H;
}

/// The stress by central differences of the energy.
Matrix3<double> gradient_of_energy(const Matrix3<double>& H) {
    const double h = 1e-5;
    Matrix3<double> P = {};
    for (int k = 0; k < 9; ++k) {
        Matrix3<double> up = H;
        Matrix3<double> down = H;
        up.at[k / 3][k % 3] += h;
        down.at[k / 3][k % 3] -= h;
        P.at[k / 3][k % 3] = (energy_of(up) - energy_of(down)) / (2 * h);
    }
    return P;
}

/// The textbook's F S, by the forces of a tet of unit edges.
Matrix3<double> textbook_stress(const Matrix3<double>& H) {
    const M3 unit = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    M3 F = unit;
    for (std::size_t k = 0; k < 9; ++k) {
        F[k / 3][k % 3] += H.at[k / 3][k % 3];
    }
    const auto forces = reference_element_forces(unit, F, tissue.mu, tissue.bulk);
    Matrix3<double> P = {};
    for (std::size_t k = 0; k < 9; ++k) {
        P.at[k / 3][k % 3] = 6 * forces[k % 3 + 1][k / 3];
    }
    return P;
}

Matrix3<float> stress_in_float(const Matrix3<double>& H) {
    Matrix3<float> single = {};
    for (int k = 0; k < 9; ++k) {
        single.at[k / 3][k % 3] = float(H.at[k / 3][k % 3]);
    }
    const Deformation<float> at = deformation(single);
    return trusted_stress(at, trusted_law(at.now, float(tissue.mu), float(tissue.bulk)));
}

using Arguments = Invariants<double>;

/// Checks a derivative of `value` against central differences along one argument.
template <class Value>
double slope_of(Value value, Arguments at, double Arguments::*along) {
    const double h = 1e-5;
    Arguments up = at;
    Arguments down = at;
    up.*along += h;
    down.*along -= h;
    return (value(law(up, tissue)) - value(law(down, tissue))) / (2 * h);
}

} // namespace

TEST_CASE("the inverse cube root of a float is good to 1e-7 over its whole range") {
    double worst = 0;
    for (int i = -85000; i <= 85000; ++i) {
        const auto x = static_cast<float>(std::exp(0.001 * i));
        worst = std::max(worst, std::abs(double(inverse_cube_root(x)) * std::cbrt(double(x)) - 1));
    }
    CHECK(worst < 1.2e-7);
    CHECK(double(inverse_cube_root(1.0F)) == doctest::Approx(1).epsilon(1e-7));
}

TEST_CASE("the law is continuous at the ends of the trusted range, its stress and volume stiffness too") {
    const double J = trusted_volume - 1;
    const double I1 = trusted_length - 3;
    const double I2 = trusted_area - 3;
    const double h = 1e-9;
    const std::array<std::array<Arguments, 2>, 4> pairs = {{{{{J - h, 3, 3}, {J + h, 3, 3}}},
                                                            {{{0.5, I1 - h, 3}, {0.5, I1 + h, 3}}},
                                                            {{{0.5, 3, I2 - h}, {0.5, 3, I2 + h}}},
                                                            {{{-1 - h, 3, 3}, {-1 + h, 3, 3}}}}};
    for (const auto& [below, above] : pairs) {
        const Energy a = law(below, tissue);
        const Energy b = law(above, tissue);
        CHECK(a.W == doctest::Approx(b.W).epsilon(1e-7));
        CHECK(a.J == doctest::Approx(b.J).epsilon(1e-7));
        CHECK(a.I1 == doctest::Approx(b.I1).epsilon(1e-7));
        CHECK(a.I2 == doctest::Approx(b.I2).epsilon(1e-7).scale(10));
        CHECK(a.d2_jj == doctest::Approx(b.d2_jj).epsilon(1e-7));
    }
}

TEST_CASE("second derivatives of the law are the slopes of the first, first those of the energy") {
    for (const Arguments& at : {Arguments{0.1, 0.5, 0.4},
                                {-0.2, 3, 2},
                                {-0.5, 1, 1},
                                {-1.4, 2, 2},
                                {0.3, 12, 2},
                                {0.3, 2, 14},
                                {-0.7, 20, 30},
                                {-3, 60, 300}}) {
        CAPTURE(at.volume_change);
        const Energy W = law(at, tissue);
        const auto agrees = [&](double exact, auto value, double Arguments::*along) {
            return slope_of(value, at, along) == doctest::Approx(exact).epsilon(1e-5).scale(1e2);
        };
        CHECK(agrees(
            W.J, [](const Energy& e) { return e.W; }, &Arguments::volume_change));
        CHECK(agrees(
            W.I1, [](const Energy& e) { return e.W; }, &Arguments::length_change));
        CHECK(agrees(
            W.I2, [](const Energy& e) { return e.W; }, &Arguments::area_change));
        CHECK(agrees(
            W.d2_jj, [](const Energy& e) { return e.J; }, &Arguments::volume_change));
        CHECK(agrees(
            W.d2_ji1, [](const Energy& e) { return e.J; }, &Arguments::length_change));
        CHECK(agrees(
            W.d2_ji2, [](const Energy& e) { return e.J; }, &Arguments::area_change));
        CHECK(agrees(
            W.d2_i1i1, [](const Energy& e) { return e.I1; }, &Arguments::length_change));
        CHECK(agrees(
            W.d2_i1i2, [](const Energy& e) { return e.I1; }, &Arguments::area_change));
        CHECK(agrees(
            W.d2_i2i2, [](const Energy& e) { return e.I2; }, &Arguments::area_change));
    }
}

TEST_CASE("stress is the gradient of energy in the trusted range, at its end and beyond it") {
    std::mt19937 engine(1);
    for (const double J : {2.0, 1.0, 0.60001, 0.6, 0.59999, 0.41, 0.2, 0.01, 0.0, -0.01, -0.5, -2.0}) {
        CAPTURE(J);
        for (const double size : {0.3, 0.3, 0.3, 1.0, 1.0, 3.0}) {
            const Matrix3<double> H = with_volume(random_matrix(engine, size), J);
            const auto [error, scale] = compare(stress_of(H), gradient_of_energy(H));
            CHECK(error < 1e-5 * scale);
        }
    }
}

TEST_CASE("the law in float is that in double to float precision, relative to the strain") {
    std::mt19937 engine(2);
    for (const double size : {1e-6, 1e-4, 1e-2, 0.1}) {
        CAPTURE(size);
        for (int i = 0; i < 50; ++i) {
            const Matrix3<double> H = random_matrix(engine, size);
            REQUIRE(is_trusted(deformation(H).now));
            const auto [error, scale] = compare(stress_of(H), stress_in_float(H));
            CHECK(error < 2e-6 * scale);
        }
    }
}

TEST_CASE("stress in the trusted range is the textbook's F S, in double and in float") {
    std::mt19937 engine(3);
    int trusted = 0;
    for (int i = 0; i < 100; ++i) {
        const Matrix3<double> H = with_volume(random_matrix(engine, 0.3), 0.6 + 0.02 * i);
        if (!is_trusted(deformation(H).now)) { continue; }
        ++trusted;
        const Matrix3<double> P = textbook_stress(H);
        const auto [error, scale] = compare(P, stress_of(H));
        CHECK(error < 1e-12 * scale);
        CHECK(compare(P, stress_in_float(H)).error < 2e-6 * scale);
    }
    CHECK(trusted > 30);
}

TEST_CASE("uniaxial tension follows the closed form") {
    // With lateral stretch q the lateral stress mu phi (q^2 - l^2) / (3 q) + K (J - 1) l q vanishes, J = l
    // q^2, and the axial stress is 2/3 mu phi (l^2 - q^2) / l + K (J - 1) q^2.
    for (const double l : {0.6, 0.9, 1.0, 1.1, 1.5, 2.5, 3.04}) {
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
