// SPDX-License-Identifier: Apache-2.0
#include "lab/calculix.hpp"

#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <sstream>

#include "base/index.hpp"
#include "base/vec.hpp"
#include "mesh/tet.hpp"

namespace lab {

using namespace resect;

namespace {

/// Corners of the edges on which CalculiX has the nodes 5 to 10 of a tet.
constexpr int mid_edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

/// Rows of nodes, those in the middle of edges after those of the mesh.
struct Elements {
    std::vector<Vec3> nodes = {};
    std::vector<std::vector<Index>> rows = {}; // [element]
};

Elements make_elements(const StaticProblem& problem) {
    Elements elements{.nodes = problem.mesh.nodes};
    std::map<std::pair<Index, Index>, Index> middle;
    for (const Tet& tet : problem.mesh.tets) {
        std::vector<Index>& rows = elements.rows.emplace_back(tet.begin(), tet.end());
        for (const auto& [a, b] : mid_edges) {
            if (!problem.quadratic) { break; }
            const Index from = tet[row(a)];
            const Index to = tet[row(b)];
            const auto [found, is_new] =
                middle.emplace(std::minmax({from, to}), static_cast<Index>(elements.nodes.size()));
            if (is_new) {
                elements.nodes.push_back(0.5 * (problem.mesh.nodes[row(from)] + problem.mesh.nodes[row(to)]));
            }
            rows.push_back(found->second);
        }
    }
    return elements;
}

void write_input(const std::string& path, const StaticProblem& problem) {
    const Elements elements = make_elements(problem);
    std::ofstream file(path);
    file << "*NODE,NSET=NALL\n";
    for (std::size_t n = 0; n < elements.nodes.size(); ++n) {
        const Vec3& p = elements.nodes[n];
        file << fmt::format("{},{:.12g},{:.12g},{:.12g}\n", n + 1, p[0], p[1], p[2]);
    }
    file << fmt::format("*ELEMENT,TYPE={},ELSET=EALL\n", problem.quadratic ? "C3D10" : "C3D4");
    for (std::size_t e = 0; e < elements.rows.size(); ++e) {
        file << e + 1;
        for (const Index node : elements.rows[e]) {
            file << ',' << node + 1;
        }
        file << '\n';
    }
    file << "*NSET,NSET=FIX\n";
    for (std::size_t n = 0; n < elements.nodes.size(); ++n) {
        if (is_inside(problem.held, elements.nodes[n])) { file << n + 1 << ",\n"; }
    }
    const double nu = problem.material.poisson;
    const double mu = problem.material.young / (2 * (1 + nu));
    const double bulk = problem.material.young / (3 * (1 - 2 * nu));
    const double pull = length(problem.gravity);
    const Vec3 down = direction(problem.gravity);
    file << "*BOUNDARY\nFIX,1,3\n*MATERIAL,NAME=M\n*HYPERELASTIC,NEO HOOKE\n"
         << fmt::format("{:.12g},{:.12g}\n*DENSITY\n{:.12g}\n", mu / 2, 2 / bulk, problem.material.density)
         << "*SOLID SECTION,ELSET=EALL,MATERIAL=M\n*STEP,NLGEOM,INC=1000\n*STATIC\n0.2,1.,1e-6,0.5\n"
         << fmt::format("*DLOAD\nEALL,GRAV,{:.12g},{:.12g},{:.12g},{:.12g}\n", pull, down[0], down[1],
                        down[2])
         << "*NODE PRINT,NSET=NALL,FREQUENCY=1000\nU\n*END STEP\n";
}

/// [node] As CalculiX printed them last.
std::vector<Vec3> read_displacements(const std::string& path) {
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

std::optional<std::vector<Vec3>> solve_by_calculix(const StaticProblem& problem, const std::string& folder) {
    const std::filesystem::path at(folder);
    std::filesystem::create_directories(at);
    write_input((at / "body.inp").string(), problem);
    std::filesystem::remove(at / "body.dat");
    const std::string command = fmt::format("cd '{}' && ccx -i body > ccx.log 2>&1", folder);
    if (std::system(command.c_str()) != 0) { return {}; }
    std::vector<Vec3> u = read_displacements((at / "body.dat").string());
    if (u.size() < problem.mesh.nodes.size()) { return {}; }
    u.resize(problem.mesh.nodes.size());
    return u;
}

} // namespace lab
