// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>
#include <numeric>
#include <random>

#include "body.hpp"
#include "fem/principal.hpp"

using namespace resect;

namespace {

using Vector12 = std::array<double, 12>;

/// Forces of a free tet in double precision.
Vector12 forces_of(const RestElement& rest, const Moduli& m, const Vector12& u) {
    double relative[3][3];
    double gradient[3][3];
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            relative[k][axis] = u[3 * (k + 1) + axis] - u[axis];
            gradient[k][axis] = rest.gradient[k + 1][axis];
        }
    }
    const Deformation<double> at = deformation(displacement_gradient(relative, gradient));
    const Matrix3<double> P = stress(at, law(at.now, m));
    Vector12 f = {};
    for (std::size_t i = 0; i < 12; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            f[i] += rest.volume * P.at[i % 3][j] * rest.gradient[i / 3][j];
        }
    }
    return f;
}

using Matrix12 = std::array<Vector12, 12>;

/// The tangent of a free tet at displacement u by central differences.
Matrix12 tangent_of(const RestElement& rest, const Moduli& m, const Vector12& u) {
    const double h = 1e-8; // m, of edges of 1e-2
    Matrix12 K = {};
    for (std::size_t j = 0; j < 12; ++j) {
        Vector12 up = u;
        Vector12 down = u;
        up[j] += h;
        down[j] -= h;
        const Vector12 a = forces_of(rest, m, up);
        const Vector12 b = forces_of(rest, m, down);
        for (std::size_t i = 0; i < 12; ++i) {
            K[i][j] = (a[i] - b[i]) / (2 * h);
        }
    }
    return K;
}

double inner(const Vector12& a, const Vector12& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Largest eigenvalue of a symmetric matrix, by power iteration with a shift that makes it positive.
double largest_eigenvalue(const Matrix12& K) {
    double norm = 0;
    for (const Vector12& line : K) {
        norm += inner(line, line);
    }
    const double shift = std::sqrt(norm) / 2;
    Vector12 x = {1, 2, -3, 4, 5, -6, 7, -8, 9, 1, -2, 3};
    double rayleigh = 0;
    for (int iteration = 0; iteration < 400; ++iteration) {
        Vector12 y = {};
        for (std::size_t i = 0; i < 12; ++i) {
            y[i] = inner(K[i], x);
        }
        rayleigh = inner(x, y) / inner(x, x);
        for (std::size_t i = 0; i < 12; ++i) {
            y[i] += shift * x[i];
        }
        const double scale = 1 / std::sqrt(inner(y, y));
        for (std::size_t i = 0; i < 12; ++i) {
            x[i] = scale * y[i];
        }
    }
    return rayleigh;
}

/// 2 / omega of a body of one free tet, as it is deformed now.
double critical_step(const TestBody& body) {
    Vector12 u = {};
    for (std::size_t k = 0; k < 12; ++k) {
        u[k] = double(body.nodes.displacement[row(body.mesh.tets[0][k / 3])][k % 3]);
    }
    const double stiffness = largest_eigenvalue(tangent_of(body.rest[0], moduli(body.material), u));
    if (stiffness <= 0) { return std::numeric_limits<double>::infinity(); }
    return 2 / std::sqrt(stiffness / (body.material.density * body.rest[0].volume / 4));
}

TestBody one_tet(std::mt19937& engine) {
    std::normal_distribution<double> normal(0, 0.005);
    TetMesh mesh;
    mesh.nodes = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}};
    for (Vec3& x : mesh.nodes) {
        x += Vec3{normal(engine), normal(engine), normal(engine)};
    }
    mesh.tets = {{0, 1, 2, 3}};
    if (signed_volume(mesh, mesh.tets[0]) < 0) { std::swap(mesh.tets[0][2], mesh.tets[0][3]); }
    return make_test_body(mesh, Material{});
}

StrainCheck check(const TestBody& body) {
    const std::vector<float> density(row(body.elements.count), float(body.material.density));
    return check_strain(body.elements, body.nodes, density, {0, body.elements.count});
}

} // namespace

TEST_CASE("eigenvalues of a symmetric matrix have its invariants") {
    std::mt19937 engine(1);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 100; ++i) {
        const Symmetric<double> A = {{normal(engine), normal(engine), normal(engine)},
                                     {normal(engine), normal(engine), normal(engine)}};
        const Vec3 e = eigenvalues(A);
        CHECK(e[0] >= e[1]);
        CHECK(e[1] >= e[2]);
        CHECK(e[0] + e[1] + e[2] == doctest::Approx(A.diagonal[0] + A.diagonal[1] + A.diagonal[2]).scale(1));
        CHECK(dot(e, e) ==
              doctest::Approx(dot(A.diagonal, A.diagonal) + 2 * dot(A.off_diagonal, A.off_diagonal)));
    }
    CHECK(eigenvalues({{2, 2, 2}, {0, 0, 0}}) == Vec3{2, 2, 2});
    const Vec3 pair = eigenvalues({{1, 1, 3}, {0, 0, 0}});
    CHECK(pair[0] == doctest::Approx(3));
    CHECK(pair[2] == doctest::Approx(1));
}

TEST_CASE("principal stretches of stretched, flattened and mirrored states") {
    const auto stretches = [](double x, double y, double z) {
        return principal_stretches({{{x - 1, 0, 0}, {0, y - 1, 0}, {0, 0, z - 1}}});
    };
    const Stretches mirrored = stretches(2, -0.5, 1);
    CHECK(mirrored.J == doctest::Approx(-1));
    CHECK(mirrored.value[0] == doctest::Approx(2));
    CHECK(mirrored.value[1] == doctest::Approx(1));
    CHECK(mirrored.value[2] == doctest::Approx(-0.5));
    CHECK(stretches(3, 1e-6, 1).value[2] == doctest::Approx(1e-6).epsilon(1e-6));
    CHECK(stretches(0, 0, 0).value == Vec3{0, 0, 0});
    CHECK(stretches(1, 1, 1).value == Vec3{1, 1, 1});
}

TEST_CASE("the live bound at rest is the rest bound") {
    std::mt19937 engine(2);
    for (int i = 0; i < 20; ++i) {
        const TestBody body = one_tet(engine);
        CHECK(check(body).live_bound == doctest::Approx(rest_bound(body)).epsilon(1e-6));
    }
}

TEST_CASE("the live bound is below the critical step of the deformed element") {
    std::mt19937 engine(3);
    double closest = 0;
    double sum = 0;
    const int count = 600;
    for (int i = 0; i < count; ++i) {
        TestBody body = one_tet(engine);
        std::normal_distribution<double> normal(0, 0.00003 * i); // up to 1.8 edges: inverted ones included
        for (Vec3f& u : body.nodes.displacement) {
            u = to_float({normal(engine), normal(engine), normal(engine)});
        }
        const double ratio = check(body).live_bound / critical_step(body);
        CHECK(ratio < 1 + 1e-4);
        closest = std::max(closest, ratio);
        sum += ratio;
    }
    MESSAGE("live bound over critical step: mean ", sum / count, ", largest ", closest);
    CHECK(sum / count > 0.4);
}

TEST_CASE("a check counts crushed and inverted copies and finds the worst") {
    TestBody body = make_test_body(kuhn_block({0.03, 0.01, 0.01}, {3, 1, 1}), Material{});
    CHECK(check(body).beyond_range == 0);
    CHECK(check(body).stretch_max == 1);
    for (std::size_t n = 0; n < body.mesh.nodes.size(); ++n) { // the cell at x = 0.02 to 0.03 is turned over
        if (body.mesh.nodes[n][0] > 0.025) { body.nodes.displacement[n] = {-0.02F, 0, 0}; }
    }
    const StrainCheck found = check(body);
    CHECK(found.inverted == 6);
    CHECK(found.beyond_range == 6);
    CHECK(found.worst_copy >= 12);
    CHECK(found.stretch_min == doctest::Approx(-1).epsilon(1e-5));
    CHECK(found.live_bound < rest_bound(body));
    const std::vector<float> density(18, 1000.0F);
    const StrainCheck halves = merge(check_strain(body.elements, body.nodes, density, {0, 9}),
                                     check_strain(body.elements, body.nodes, density, {9, 18}));
    CHECK(halves.worst_copy == found.worst_copy);
    CHECK(halves.live_bound == found.live_bound);
    CHECK(halves.inverted == 6);
}
