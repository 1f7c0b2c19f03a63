// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <doctest/doctest.h>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "body.hpp"

using namespace resect;

namespace {

void kick(TestBody& body, double speed, unsigned seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal(0, speed);
    for (Vec3f& v : body.nodes.velocity) {
        v = to_float({normal(engine), normal(engine), normal(engine)});
    }
}

TestBody make_cube(double viscous_time = 0) {
    return make_test_body(kuhn_block({0.1, 0.1, 0.1}, {4, 4, 4}), Material{}, viscous_time);
}

struct Momentum {
    Vec3 linear = {}, angular = {};
    double scale = 0; // sum of m |v|
};

Momentum momentum(const TestBody& body) {
    Momentum sum;
    for (std::size_t n = 0; n < body.mesh.nodes.size(); ++n) {
        const Vec3 p = double(body.nodes.mass[n]) * to_double(body.nodes.velocity[n]);
        sum.linear += p;
        sum.angular += cross(body.mesh.nodes[n] + to_double(body.nodes.displacement[n]), p);
        sum.scale += length(p);
    }
    return sum;
}

} // namespace

TEST_CASE("a free fall is exact") {
    TestBody body = make_cube(1e-4);
    const StepConstants constants{1e-3F, 0, {0, 0, -9.81F}};
    for (int i = 0; i < 100; ++i) {
        step(body, constants);
    }
    // Leapfrog from rest half a step before: u_n = g dt^2 n (n + 1) / 2.
    const double expected = -9.81 * 1e-6 * 100 * 101 / 2;
    for (const Vec3f& u : body.nodes.displacement) {
        CHECK(std::abs(u[0]) < 1e-6 * std::abs(expected)); // forces of rounding
        CHECK(double(u[2]) == doctest::Approx(expected).epsilon(2e-6));
    }
}

TEST_CASE("mass-proportional damping slows a free body as central differences say") {
    TestBody body = make_cube();
    for (Vec3f& v : body.nodes.velocity) {
        v = {1, 0, 0};
    }
    const StepConstants constants{1e-3F, 5, {}};
    double damping_work = 0;
    for (int i = 0; i < 100; ++i) {
        damping_work += step(body, constants).damping_work;
    }
    const double factor = std::pow((1 - 0.0025) / (1 + 0.0025), 100);
    CHECK(double(body.nodes.velocity[0][0]) == doctest::Approx(factor).epsilon(1e-5));
    CHECK(damping_work == doctest::Approx(0.5 * (1 - factor * factor)).epsilon(1e-4));
}

namespace {

/// Change over 1000 steps of a kicked free cube, over the sum of m |v| (and its size, for angular momentum).
Momentum momentum_change(double viscous_share) {
    TestBody body = make_cube(viscous_share * rest_bound(make_cube()));
    kick(body, 0.05, 1);
    const StepConstants constants{float(0.7 * rest_bound(body)), 0, {}};
    const Momentum before = momentum(body);
    for (int i = 0; i < 1000; ++i) {
        step(body, constants);
    }
    const Momentum after = momentum(body);
    return {(1 / before.scale) * (after.linear - before.linear),
            (10 / before.scale) * (after.angular - before.angular), before.scale};
}

} // namespace

TEST_CASE("momentum is conserved over 1000 steps without loads") {
    const Momentum change = momentum_change(0);
    CHECK(length(change.linear) < 1e-6);
    CHECK(length(change.angular) < 1e-6);
    CHECK(change.scale > 0.01);
    CHECK(length(momentum_change(0.1).linear) < 1e-6);
}

TEST_CASE("energy does not drift without damping") {
    TestBody body = make_cube();
    kick(body, 0.05, 2);
    const StepConstants constants{float(0.5 * rest_bound(body)), 0, {}};
    const auto total = [&] {
        step(body, constants);
        const double before = kinetic_energy(body.nodes); // at half steps
        const double elastic = elastic_energy(body.elements, body.nodes.displacement);
        step(body, constants);
        const double after = kinetic_energy(body.nodes);
        return (before + after) / 2 + elastic;
    };
    double early = 0;
    double late = 0;
    for (int i = 0; i < 100; ++i) {
        early += total() / 100;
    }
    for (int i = 0; i < 1800; ++i) {
        step(body, constants);
    }
    for (int i = 0; i < 100; ++i) {
        late += total() / 100;
    }
    CHECK(late == doctest::Approx(early).epsilon(5e-3));
}

TEST_CASE("kinetic energy and works balance to rounding in every step") {
    TestBody body = make_cube(1e-4);
    hold_where(body, [](const Vec3& x) { return x[0] == 0; });
    body.nodes.load[124] = {0.1F, 0, 0.2F};
    const StepConstants constants{float(0.7 * rest_bound(body)), 2, {0, 0, -9.81F}};
    double kinetic = 0;
    double throughput = 0;
    double error = 0;
    for (int i = 0; i < 300; ++i) {
        const std::vector<Vec3f> before = body.nodes.velocity;
        const StepSums sums = step(body, constants);
        double applied = 0;
        for (std::size_t node = 0; node < before.size(); ++node) {
            const Vec3 mean = 0.5 * (to_double(before[node]) + to_double(body.nodes.velocity[node]));
            applied +=
                double(constants.time_step) * dot(applied_force(body.nodes, constants, Index(node)), mean);
        }
        const double work = applied - sums.internal_work - sums.damping_work;
        const double now = kinetic_energy(body.nodes);
        error = std::max(error, std::abs(now - kinetic - work));
        kinetic = now;
        throughput = std::max(throughput, kinetic);
    }
    CHECK(throughput > 1e-3);
    CHECK(error < 1e-7 * throughput);
}

TEST_CASE("the internal work of a slow undamped motion is the elastic energy") {
    TestBody body = make_cube();
    hold_where(body, [](const Vec3& x) { return x[0] == 0; });
    const StepConstants constants{float(0.1 * rest_bound(body)), 0, {0, 0, -9.81F}};
    double work = 0;
    for (int i = 0; i < 400; ++i) {
        work += step(body, constants).internal_work;
    }
    // Works end half a step before the displacement of now, so the last force counts half.
    all_forces(body);
    double rest_of_work = 0;
    const std::vector<Vec3> force = nodal_forces(body);
    for (std::size_t n = 0; n < force.size(); ++n) {
        rest_of_work += 0.5 * double(constants.time_step) * dot(force[n], to_double(body.nodes.velocity[n]));
    }
    CHECK(work + rest_of_work ==
          doctest::Approx(elastic_energy(body.elements, body.nodes.displacement)).epsilon(1e-3));
}

TEST_CASE("the first axial frequency of a bar is that of the wave equation within 2 %") {
    // nu = 0: c = sqrt(E / rho), fixed-free, f = c / (4 L).
    Material material;
    material.poisson = 0;
    const double bar = 0.2;
    TestBody body = make_test_body(kuhn_block({bar, 0.02, 0.02}, {40, 4, 4}), material);
    hold_where(body, [](const Vec3& x) { return x[0] == 0; });
    for (std::size_t n = 0; n < body.mesh.nodes.size(); ++n) {
        const double phase = std::numbers::pi / 2 * body.mesh.nodes[n][0] / bar;
        body.nodes.displacement[n] = to_float({1e-5 * std::sin(phase), 0, 0});
    }
    const StepConstants constants{float(0.7 * rest_bound(body)), 0, {}};
    const std::size_t tip = body.mesh.nodes.size() - 1;
    double first = 0;
    double last = 0;
    int crossings = 0;
    float before = body.nodes.displacement[tip][0];
    for (int i = 1; crossings < 9 && i < 20000; ++i) {
        step(body, constants);
        const float now = body.nodes.displacement[tip][0];
        if ((before > 0) != (now > 0)) {
            const double at = (i - 1 + double(before) / double(before - now)) * double(constants.time_step);
            (crossings == 0 ? first : last) = at;
            ++crossings;
        }
        before = now;
    }
    REQUIRE(crossings == 9);
    const double frequency = 4 / (last - first); // eight half periods
    const double expected = std::sqrt(material.young / material.density) / (4 * bar);
    MESSAGE("frequency over that of the wave equation: ", frequency / expected);
    CHECK(frequency == doctest::Approx(expected).epsilon(0.02));
}

TEST_CASE("a held node stays where its caller put it, and pulls") {
    TestBody body = make_cube();
    hold_where(body, [](const Vec3& x) { return x[0] == 0; });
    body.nodes.displacement[0] = {-0.01F, 0, 0};
    body.nodes.velocity[0] = {0.5F, 0, 0};
    const StepConstants constants{float(0.5 * rest_bound(body)), 0, {0, 0, -9.81F}};
    step(body, constants);
    CHECK(body.nodes.displacement[0] == Vec3f{-0.01F, 0, 0});
    CHECK(body.nodes.velocity[0] == Vec3f{0.5F, 0, 0});
    CHECK(body.nodes.velocity[1][0] < 0); // its neighbour along x
}

TEST_CASE("what is not finite shows in the largest speed") {
    const StepConstants constants{1e-4F, 0, {}};
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        TestBody moved = make_cube();
        moved.nodes.displacement[60][1] = bad;
        CHECK_FALSE(std::isfinite(step(moved, constants).speed_squared));
        TestBody fast = make_cube();
        fast.nodes.velocity[0][2] = bad;
        CHECK_FALSE(std::isfinite(step(fast, constants).speed_squared));
    }
    TestBody sound = make_cube();
    sound.nodes.velocity[3] = {3, 0, 4};
    CHECK(step(sound, {0, 0, {}}).speed_squared == 16); // the largest along an axis
}

TEST_CASE("the out-of-balance force is the applied one at rest and vanishes in equilibrium") {
    TestBody body = make_cube(1e-3);
    hold_where(body, [](const Vec3& x) { return x[2] == 0; });
    const StepConstants constants{float(0.5 * rest_bound(body)), 20, {0, 0, -1.0F}};
    const Range all = {0, node_count(body)};
    all_forces(body);
    const auto squares = [&](auto force) {
        double sum = 0;
        for (Index node = all.begin; node < all.end; ++node) {
            if (body.nodes.inverse_mass[row(node)] == 0) { continue; }
            const Vec3 f = force(node);
            sum += dot(f, f);
        }
        return sum;
    };
    const auto net = [&](Index node) { return net_force(body.packing, body.nodes, constants, node); };
    const double applied = squares([&](Index node) { return applied_force(body.nodes, constants, node); });
    CHECK(squares(net) == doctest::Approx(applied).epsilon(1e-5));
    CHECK(applied > 0);
    for (int i = 0; i < 3000; ++i) {
        step(body, constants);
    }
    all_forces(body);
    CHECK(std::sqrt(squares(net) / applied) < 1e-4);
}

namespace {

/// What a free block with the automatic viscosity comes to in 3000 of the steps that a simulation takes.
StrainCheck strain_after(const std::function<Vec3(const Vec3&)>& displacement) {
    TestBody body = make_cube(0.1 * rest_bound(make_cube()));
    for (std::size_t n = 0; n < body.mesh.nodes.size(); ++n) {
        body.nodes.displacement[n] = to_float(displacement(body.mesh.nodes[n]));
    }
    const StepConstants constants{float(0.6 * rest_bound(body)), 2, {}};
    for (int i = 0; i < 3000; ++i) {
        step(body, constants);
    }
    const std::vector<float> density(row(body.elements.count), 1000.0F);
    return check_strain(body.elements, body.nodes, density, {0, body.elements.count});
}

} // namespace

TEST_CASE("a block that was crushed flat, turned inside out or scrambled comes back to rest") {
    std::mt19937 engine(3);
    std::normal_distribution<double> normal(0, 0.0125); // half a cell
    const auto flat = [](const Vec3& x) { return Vec3{0, 0, -x[2]}; };
    const auto mirrored = [](const Vec3& x) { return Vec3{0, 0, -2 * x[2]}; };
    const auto scrambled = [&](const Vec3&) { return Vec3{normal(engine), normal(engine), normal(engine)}; };
    for (const StrainCheck& end : {strain_after(flat), strain_after(mirrored), strain_after(scrambled)}) {
        CHECK(end.inverted == 0);
        CHECK(end.beyond_range == 0);
        CHECK(end.stretch_min > 0.99);
        CHECK(end.stretch_max < 1.01);
    }
}
