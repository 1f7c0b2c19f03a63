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

/// A surface as files hold it: one point for each material vertex, so that readers find it closed.
struct Welded {
    std::vector<Index> vertex = {};                  // [point] the first of its vertices
    std::vector<std::array<Index, 3>> triangle = {}; // rows of points
};

/// Points in the order of their first vertices. A surface that names no points has one for each vertex.
Welded weld(const Surface& surface) {
    Welded welded;
    std::vector<Index> point_of(surface.position.size());
    std::vector<Index> number;
    for (std::size_t v = 0; v < surface.position.size(); ++v) {
        const std::size_t at = surface.point.empty() ? v : row(surface.point[v]);
        if (at >= number.size()) { number.resize(at + 1, -1); }
        if (number[at] < 0) {
            number[at] = static_cast<Index>(welded.vertex.size());
            welded.vertex.push_back(static_cast<Index>(v));
        }
        point_of[v] = number[at];
    }
    for (const auto& [a, b, c] : surface.triangle) {
        welded.triangle.push_back({point_of[row(a)], point_of[row(b)], point_of[row(c)]});
    }
    return welded;
}

/// The rows of `values` that the points' first vertices have; none of none.
std::vector<Vec3f> at_points(const Welded& welded, std::span<const Vec3f> values) {
    std::vector<Vec3f> at;
    if (values.empty()) { return at; }
    at.reserve(welded.vertex.size());
    for (const Index v : welded.vertex) {
        at.push_back(values[row(v)]);
    }
    return at;
}

/// Corners name a point and, for the crease at the lips, a normal of their own side.
std::string obj(const Surface& surface) {
    std::string text;
    auto out = std::back_inserter(text);
    const Welded welded = weld(surface);
    for (const Vec3f& p : at_points(welded, surface.position)) {
        fmt::format_to(out, "v {} {} {}\n", p[0], p[1], p[2]);
    }
    for (const Vec3f& n : surface.normal) {
        fmt::format_to(out, "vn {} {} {}\n", n[0], n[1], n[2]);
    }
    for (std::size_t i = 0; i < surface.triangle.size(); ++i) {
        const auto& p = welded.triangle[i];
        const auto& n = surface.triangle[i];
        if (surface.normal.empty()) {
            fmt::format_to(out, "f {} {} {}\n", p[0] + 1, p[1] + 1, p[2] + 1);
        } else {
            fmt::format_to(out, "f {}//{} {}//{} {}//{}\n", p[0] + 1, n[0] + 1, p[1] + 1, n[1] + 1, p[2] + 1,
                           n[2] + 1);
        }
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

/// Without faces and pieces: meshio fails on numbers of triangles in a binary .ply; .vtp has them. Its
/// normals belong to points: they are left out where a point has several, once there is a cut.
std::string ply(const Surface& surface) {
    const Welded welded = weld(surface);
    const bool has_normals = !surface.normal.empty() && surface.normal.size() == welded.vertex.size();
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
        "property float z\n{}element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        welded.vertex.size(), has_normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
        surface.triangle.size());
    for (const Index v : welded.vertex) {
        append_bytes(bytes, surface.position[row(v)]);
        if (has_normals) { append_bytes(bytes, surface.normal[row(v)]); }
    }
    for (const auto& triangle : welded.triangle) {
        append_bytes(bytes, std::uint8_t{3});
        append_bytes(bytes, triangle);
    }
    return bytes;
}

/// VTK knows normals of points and of cells only: those of the corners are numbers of the cells.
VtkArray corner_normals(const Surface& surface) {
    std::vector<std::array<float, 9>> normals;
    normals.reserve(surface.triangle.size());
    for (const auto& triangle : surface.triangle) {
        std::array<float, 9>& own = normals.emplace_back();
        for (std::size_t k = 0; k < 9; ++k) {
            own[k] = surface.normal[row(triangle[k / 3])][k % 3];
        }
    }
    return vtk_array("corner_normals", std::span<const std::array<float, 9>>(normals));
}

std::string vtp(const Surface& surface) {
    const Welded welded = weld(surface);
    const std::vector<Vec3f> position = at_points(welded, surface.position);
    const std::vector<Vec3f> rest = at_points(welded, surface.rest);
    std::vector<VtkArray> of_cells = {vtk_array("face", surface.face), vtk_array("piece", surface.piece)};
    if (!surface.normal.empty()) { of_cells.push_back(corner_normals(surface)); }
    const VtkSection sections[] = {
        {"PointData", {vtk_array("rest", std::span<const Vec3f>(rest))}},
        {"CellData", std::move(of_cells)},
        {"Points", {vtk_array("Points", std::span<const Vec3f>(position))}},
        {"Polys", vtk_cells(std::span<const std::array<Index, 3>>(welded.triangle))},
    };
    const std::string counts =
        fmt::format("NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                    "NumberOfPolys=\"{}\"",
                    position.size(), surface.triangle.size());
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
