// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>

#include "options.hpp"

namespace cli {

namespace {

using resect::Body;
using resect::Result;

Result<Body> make(const MeshOptions& options) {
    if (options.source == "liver") { return resect::make_liver(options.lattice); }
    if (options.source == "kidney") { return resect::make_kidney(options.lattice); }
    if (options.source == "block") {
        const resect::Vec3 size{options.size[0], options.size[1], options.size[2]};
        const std::array<resect::Index, 3> cells{options.cells[0], options.cells[1], options.cells[2]};
        return resect::make_block(size, cells,
                                  options.split == "bcc" ? resect::Split::bcc : resect::Split::six);
    }
    return resect::Error{fmt::format("mesh: '{}' is not a body that can be made; give liver, kidney or block",
                                     options.source)};
}

bool is_surface(const std::string& path) {
    const std::string ending = std::filesystem::path(path).extension().string();
    constexpr std::array<const char*, 4> surfaces{".obj", ".stl", ".ply", ".vtp"};
    return std::find(surfaces.begin(), surfaces.end(), ending) != surfaces.end();
}

Result<void> write(const std::string& path, const Body& body) {
    if (!is_surface(path)) { return resect::write_body(path, body); }
    Result<resect::Simulation> simulation = resect::Simulation::create({.body = body, .threads = 1});
    if (!simulation) { return simulation.error(); }
    return resect::write_surface(path, simulation->surface());
}

void print(const resect::MeshInfo& info) {
    fmt::print("nodes          {}\n", info.nodes);
    fmt::print("tets           {} in {} component{}\n", info.tets, info.components,
               info.components == 1 ? "" : "s");
    fmt::print("boundary       {} triangles\n", info.boundary_triangles);
    fmt::print("size           {:.6g} x {:.6g} x {:.6g} m, from ({:.6g}, {:.6g}, {:.6g})\n",
               info.bounds.hi[0] - info.bounds.lo[0], info.bounds.hi[1] - info.bounds.lo[1],
               info.bounds.hi[2] - info.bounds.lo[2], info.bounds.lo[0], info.bounds.lo[1],
               info.bounds.lo[2]);
    fmt::print("volume         {:.6g} m^3, elements {:.3g} to {:.3g} m^3\n", info.volume, info.volume_min,
               info.volume_max);
    fmt::print("dihedral       {:.1f} to {:.1f} degrees\n", info.dihedral_min, info.dihedral_max);
    fmt::print("altitude       smallest {:.3g} m, median {:.3g} m\n", info.altitude_min,
               info.altitude_median);
    fmt::print("fractions      {} elements partly filled, least share {:.2g}\n", info.elements_partial,
               info.fraction_min);
    fmt::print("stable step    {:.4g} ms at rest for E 5000 Pa, nu 0.35, 1000 kg/m^3\n",
               1e3 * info.time_step_bound);
}

} // namespace

int mesh(const MeshOptions& options) {
    const Result<Body> body = make(options);
    if (!body) { return refuse(body.error().message); }
    if (const Result<void> written = write(options.out, *body); !written) {
        return refuse(written.error().message);
    }
    print(resect::describe(*body));
    return done;
}

int info(const std::string& path) {
    const Result<Body> body = resect::load_body(path);
    if (!body) { return refuse(body.error().message); }
    for (const std::string& note : body->notes) {
        fmt::print("note           {}\n", note);
    }
    print(resect::describe(*body));
    return done;
}

} // namespace cli
