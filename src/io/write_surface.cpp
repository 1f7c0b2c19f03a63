// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <iterator>

#include "resect/files.hpp"

#include "base/index.hpp"
#include "base/vec.hpp"
#include "io/bytes.hpp"
#include "io/file.hpp"
#include "io/vtk_xml.hpp"

namespace resect {

namespace {

std::string obj(const Surface& surface) {
    std::string text;
    auto out = std::back_inserter(text);
    for (const Vec3f& p : surface.position) {
        fmt::format_to(out, "v {} {} {}\n", p[0], p[1], p[2]);
    }
    for (const auto& t : surface.triangle) {
        fmt::format_to(out, "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    return text;
}

std::string stl(const Surface& surface) {
    std::string bytes = "binary STL by Resect";
    bytes.resize(80, ' ');
    append_bytes(bytes, static_cast<std::uint32_t>(surface.triangle.size()));
    for (const auto& triangle : surface.triangle) {
        const Vec3f& a = surface.position[row(triangle[0])];
        const Vec3f& b = surface.position[row(triangle[1])];
        const Vec3f& c = surface.position[row(triangle[2])];
        const Vec3 normal = cross(to_double(b) - to_double(a), to_double(c) - to_double(a));
        for (const Vec3f& vector : {to_float(direction(normal)), a, b, c}) {
            append_bytes(bytes, vector);
        }
        append_bytes(bytes, std::uint16_t{0});
    }
    return bytes;
}

/// Without faces and pieces: meshio fails on numbers of triangles in a binary .ply; .vtp has them.
std::string ply(const Surface& surface) {
    const bool has_normals = !surface.normal.empty();
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
        "property float z\n{}element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        surface.position.size(),
        has_normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
        surface.triangle.size());
    for (std::size_t vertex = 0; vertex < surface.position.size(); ++vertex) {
        append_bytes(bytes, surface.position[vertex]);
        if (has_normals) { append_bytes(bytes, surface.normal[vertex]); }
    }
    for (const auto& triangle : surface.triangle) {
        append_bytes(bytes, std::uint8_t{3});
        append_bytes(bytes, triangle);
    }
    return bytes;
}

std::string vtp(const Surface& surface) {
    std::vector<VtkArray> of_points = {vtk_array("rest", surface.rest)};
    if (!surface.normal.empty()) { of_points.push_back(vtk_array("normal", surface.normal)); }
    const VtkSection sections[] = {
        {"PointData", std::move(of_points)},
        {"CellData", {vtk_array("face", surface.face), vtk_array("piece", surface.piece)}},
        {"Points", {vtk_array("Points", surface.position)}},
        {"Polys", vtk_cells(surface.triangle)},
    };
    const std::string counts =
        fmt::format("NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                    "NumberOfPolys=\"{}\"",
                    surface.position.size(), surface.triangle.size());
    return vtk_xml("PolyData", counts, sections);
}

} // namespace

Result<void> write_surface(const std::string& path, const Surface& surface) {
    const std::string ending = ending_of(path);
    if (ending == ".obj") { return write_file(path, obj(surface)); }
    if (ending == ".stl") { return write_file(path, stl(surface)); }
    if (ending == ".ply") { return write_file(path, ply(surface)); }
    if (ending == ".vtp") { return write_file(path, vtp(surface)); }
    return Error{path + ": a surface is written as .obj, .stl, .ply or .vtp; end the name with one of these"};
}

Result<void> write_rest_surface(const std::string& path, const Surface& surface) {
    Surface at_rest = surface;
    at_rest.position = surface.rest;
    at_rest.normal = {}; // those given are of the deformed surface
    return write_surface(path, at_rest);
}

} // namespace resect
