// SPDX-License-Identifier: Apache-2.0
// The beam that CalculiX 2.20 and GetFEM 5.4.2 agree on to 1e-6 m, on the very same meshes: 0.2 x 0.05 x 0.05
// m, x = 0 clamped, its own weight along -z, nu 0.35, 1000 kg/m^3.
#include <array>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

#include "resect/resect.hpp"

#include "base/index.hpp"
#include "base/vec.hpp"
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

/// The input of CalculiX for the same mesh.
void write_inp(const std::string& path, const Beam& beam) {
    const Setup setup = hang(beam);
    std::ofstream file(path);
    file << "*NODE,NSET=NALL\n";
    const TetMesh& mesh = setup.body.elements;
    for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
        const Vec3& p = mesh.nodes[node];
        file << fmt::format("{},{:.9g},{:.9g},{:.9g}\n", node + 1, p[0], p[1], p[2]);
    }
    file << "*ELEMENT,TYPE=C3D4,ELSET=EALL\n";
    for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) {
        const auto& t = mesh.tets[tet];
        file << fmt::format("{},{},{},{},{}\n", tet + 1, t[0] + 1, t[1] + 1, t[2] + 1, t[3] + 1);
    }
    file << "*NSET,NSET=FIX\n";
    for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
        if (mesh.nodes[node][0] == 0) { file << node + 1 << ",\n"; }
    }
    const double nu = setup.materials[0].poisson, mu = beam.young / (2 * (1 + nu)),
                 bulk = beam.young / (3 * (1 - 2 * nu));
    file << "*BOUNDARY\nFIX,1,3\n*MATERIAL,NAME=M\n*HYPERELASTIC,NEO HOOKE\n"
         << fmt::format("{:.9g},{:.9g}\n", mu / 2, 2 / bulk)
         << "*DENSITY\n1000\n*SOLID "
            "SECTION,ELSET=EALL,MATERIAL=M\n*STEP,NLGEOM,INC=1000\n*STATIC\n0.05,1.,1e-6,0.1\n"
         << "*DLOAD\nEALL,GRAV,9.81,0.,0.,-1.\n*NODE PRINT,NSET=NALL,FREQUENCY=1000\nU\n*END STEP\n";
}

/// Displacements that CalculiX printed, by node; empty where it printed none.
std::vector<Vec3> read_dat(const std::string& path) {
    std::ifstream file(path);
    std::vector<Vec3> u;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::size_t node = 0;
        Vec3 value = {};
        if (words >> node >> value[0] >> value[1] >> value[2]) {
            if (node == 1) { u.clear(); }
            u.push_back(value);
        }
    }
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
    const TemporaryFolder folder;
    write_inp(folder.file("beam.inp"), beam);
    const int status =
        std::system(fmt::format("cd {} && ccx -i beam > ccx.log 2>&1", folder.file("")).c_str());
    REQUIRE_MESSAGE(status == 0, "CalculiX (ccx) did not run; ./test installs it");
    const std::vector<Vec3> expected = read_dat(folder.file("beam.dat"));

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
