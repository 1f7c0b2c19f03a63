// SPDX-License-Identifier: Apache-2.0
// The beam that CalculiX 2.20 and GetFEM 5.4.2 agree on to 1e-6 m, on the very same meshes: 0.2 x 0.05 x 0.05
// m, x = 0 clamped, its own weight along -z, nu 0.35, 1000 kg/m^3.
#include <array>
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "resect/resect.hpp"

#include "base/index.hpp"
#include "base/vec.hpp"
#include "lab/calculix.hpp"
#include "temporary_folder.hpp"

using namespace resect;

namespace {

constexpr Vec3 beam_size{0.2, 0.05, 0.05};

struct Beam {
    std::array<Index, 3> cells = {};
    double young = 0; // Pa
};

Setup hang(const Beam& beam) {
    Setup setup{
        .body = must(make_block(beam_size, beam.cells)), .materials = {{.young = beam.young}}, .threads = 1};
    setup.fixed = {{.box = {.lo = {0, -1, -1}, .hi = {0, 1, 1}}}};
    return setup;
}

Index end_face_centre(const Beam& beam) {
    const auto [nx, ny, nz] = beam.cells;
    return nx + (nx + 1) * (ny / 2 + (ny + 1) * (nz / 2));
}

std::vector<Vec3> settled_displacement(const Beam& beam) {
    Simulation simulation = must(Simulation::create(hang(beam)));
    const StepReport report = simulation.settle(1e-4, 60);
    CHECK(report.status == Status::ok);
    CHECK(simulation.strain().elements_beyond_range == 0);
    std::vector<Vec3> u;
    for (const Vec3f& at : simulation.nodes().displacement) {
        u.push_back(to_double(at));
    }
    MESSAGE(fmt::format("E {:g}: settled in {} steps of {:.3g} s; stretch {:.2f} to {:.2f}", beam.young,
                        report.steps, simulation.time_step().used, simulation.strain().stretch_min,
                        simulation.strain().stretch_max));
    return u;
}

} // namespace

TEST_CASE("the end of a beam under its own weight sags as CalculiX and GetFEM say") {
    struct Golden {
        Beam beam = {};
        Vec3 u = {};
    };
    const Golden golden[] = {{{{16, 4, 4}, 1e5}, {-0.013112, 0.004858, -0.070462}},
                             {{{16, 4, 4}, 5e3}, {-0.173401, 0.000282, -0.252956}},
                             {{{24, 6, 6}, 1e5}, {-0.016295, 0.002749, -0.078060}}};
    for (const Golden& row : golden) {
        CAPTURE(row.beam.young);
        CAPTURE(row.beam.cells[0]);
        const Vec3 u = settled_displacement(row.beam)[resect::row(end_face_centre(row.beam))];
        const double error = length(u - row.u) / length(row.u);
        MESSAGE(fmt::format("cells {}, E {:g}: ({:.6f}, {:.6f}, {:.6f}) m, off by {:.4f} %",
                            row.beam.cells[0], row.beam.young, u[0], u[1], u[2], 100 * error));
        CHECK(error < 1e-3);
    }
}

TEST_CASE("every node of a beam sags as in CalculiX") {
    const Beam beam{{16, 4, 4}, 1e5};
    const Setup setup = hang(beam);
    const TemporaryFolder folder;
    const std::optional<std::vector<Vec3>> solved =
        lab::solve_by_calculix({setup.body.elements, setup.materials[0], setup.fixed[0].box, setup.gravity},
                               folder.file("calculix"));
    REQUIRE_MESSAGE(solved, "CalculiX (ccx) did not run; ./test installs it");
    const std::vector<Vec3>& expected = *solved;

    const std::vector<Vec3> u = settled_displacement(beam);
    REQUIRE(expected.size() == u.size());
    const double size = length(expected[row(end_face_centre(beam))]);
    double worst = 0;
    for (std::size_t node = 0; node < u.size(); ++node) {
        worst = std::max(worst, length(u[node] - expected[node]));
    }
    MESSAGE(fmt::format("worst of {} nodes: {:.3g} m, {:.4f} % of the end's displacement", u.size(), worst,
                        100 * worst / size));
    CHECK(worst < 1e-3 * size);
}
