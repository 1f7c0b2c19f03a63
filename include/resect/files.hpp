// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "resect/simulation.hpp"

namespace resect {

/// One blade's way: it exists from its first key to its last, and its ends move linearly between keys.
struct BladeKey {
    double time = 0; // s, from the end of settle
    Edge edge = {};
};

struct Settle {
    double residual = 1e-4;
    double at_most = 30; // simulated s
};

struct Scene {
    std::string name = {};
    std::string description = {}; // free text: what it shows and why its values are what they are
    Setup setup = {};
    bool settle = false;
    Settle settling = {};
    std::vector<std::vector<BladeKey>> blades = {}; // [blade][key], by time
    double duration = 1;                            // s
    double output_every = 1.0 / 60;                 // s
};

/// Reads a scene (JSON, scenes/scene.schema.json). `overrides` are `key=value` with dots for nesting
/// ("tissue.damping=1"); a value is JSON, or else a string. Paths in it are relative to its folder.
Result<Scene> load_scene(const std::string& path, std::span<const std::string> overrides = {});

/// The boundary of the material by the ending of `path`: .obj, .stl, .ply, .vtp. All but .stl hold one point
/// for each of Surface::point, so that they are closed. Normals are those of corners in .obj (`f v//vn`) and
/// .vtp (cell array `corner_normals`), of facets in .stl, and of points in .ply, as long as no cut gives a
/// point two.
Result<void> write_surface(const std::string& path, const Surface& surface);
/// The same at rest.
Result<void> write_rest_surface(const std::string& path, const Surface& surface);
/// The element copies with their fields, as .vtu (points at rest, docs/manual.md lists the arrays).
Result<void> write_mesh(const std::string& path, const Simulation& simulation);
/// A body's elements, as .vtu, .vtk (ASCII) or .msh (2.2, ASCII). Regions are written, and not read back. The
/// node sets go into .vtu (a UInt8 point array each, 1 inside) and .msh (a physical group each), and
/// load_body() takes them from there.
Result<void> write_body(const std::string& path, const Body& body);

/// The bytes of a snapshot, as a file.
Result<void> write_snapshot(const std::string& path, const Snapshot& snapshot);
Result<Snapshot> load_snapshot(const std::string& path);

/// A command as one JSON object, {"move_blade": {"blade": 0, "heel": [x, y, z], "tip": [x, y, z]}}: so
/// records hold it, and pages send it (docs/manual.md, "Records").
std::string format_command(const Command& command);
Result<Command> parse_command(const std::string& text);

/// All that was done to a scene, to be done again.
struct Record {
    std::string scene = {}; // path; in the file it counts from the file's folder
    std::vector<std::string> overrides = {};
    std::vector<Recorded> commands = {};
    std::int64_t steps = 0; // since creation, at the end
    std::uint64_t hash = 0; // Simulation::hash() then
};
Result<void> write_record(const std::string& path, const Record& record);
/// What was done so far to a simulation of the scene at the path `scene`.
Result<void> write_record(const std::string& path, const std::string& scene,
                          std::span<const std::string> overrides, const Simulation& simulation);
Result<Record> load_record(const std::string& path);

/// One file of a series in time.
struct SeriesEntry {
    double time = 0;       // s
    std::string file = {}; // relative to the folder of the series
};
/// A ParaView collection, .pvd.
Result<void> write_series(const std::string& path, std::span<const SeriesEntry> entries);

/// What `resect info` prints.
struct MeshInfo {
    Index nodes = 0, tets = 0, components = 0, boundary_triangles = 0;
    Box bounds = {};
    double volume = 0;                            // m^3
    double volume_min = 0, volume_max = 0;        // of an element
    double dihedral_min = 0, dihedral_max = 0;    // degrees
    double altitude_min = 0, altitude_median = 0; // m
    double fraction_min = 1;                      // least material share of an element
    Index elements_partial = 0;                   // elements with a share below one
    double time_step_bound = 0;                   // s, at rest, for the material given
};
MeshInfo describe(const Body& body, const Material& material = {});

} // namespace resect
