// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <iterator>

#include "resect/files.hpp"

#include "base/index.hpp"
#include "io/file.hpp"
#include "io/vtk_xml.hpp"

namespace resect {

namespace {

/// Node sets become UInt8 point arrays that are 1 in the set.
std::string body_vtu(const Body& body) {
    const TetMesh& mesh = body.elements;
    VtkSection of_points{"PointData", {}};
    for (const auto& [name, nodes] : body.node_sets) {
        std::vector<std::uint8_t> inside(mesh.nodes.size(), 0);
        for (const Index node : nodes) {
            inside[row(node)] = 1;
        }
        of_points.arrays.push_back(vtk_array(name, std::span<const std::uint8_t>(inside)));
    }
    VtkSection of_cells{"CellData", {}};
    if (!body.region.empty()) {
        of_cells.arrays.push_back(vtk_array("region", std::span<const Index>(body.region)));
    }
    const VtkSection sections[] = {
        std::move(of_points),
        std::move(of_cells),
        {"Points", {vtk_array("Points", std::span<const Vec3>(mesh.nodes))}},
        vtk_tets(mesh.tets),
    };
    const std::string counts =
        fmt::format("NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", mesh.nodes.size(), mesh.tets.size());
    return vtk_xml("UnstructuredGrid", counts, sections);
}

/// Legacy, ASCII: the format's plainest form, read by everything.
std::string body_vtk(const Body& body) {
    const TetMesh& mesh = body.elements;
    std::string text = "# vtk DataFile Version 3.0\ntetrahedra by Resect\nASCII\nDATASET UNSTRUCTURED_GRID\n";
    auto out = std::back_inserter(text);
    fmt::format_to(out, "POINTS {} double\n", mesh.nodes.size());
    for (const Vec3& p : mesh.nodes) {
        fmt::format_to(out, "{} {} {}\n", p[0], p[1], p[2]);
    }
    fmt::format_to(out, "CELLS {} {}\n", mesh.tets.size(), 5 * mesh.tets.size());
    for (const auto& t : mesh.tets) {
        fmt::format_to(out, "4 {} {} {} {}\n", t[0], t[1], t[2], t[3]);
    }
    fmt::format_to(out, "CELL_TYPES {}\n", mesh.tets.size());
    for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) {
        text += "10\n";
    }
    return text;
}

std::size_t count_of_set_nodes(const Body& body) {
    std::size_t count = 0;
    for (const auto& [name, nodes] : body.node_sets) {
        count += nodes.size();
    }
    return count;
}

/// A name between the quotes of a .msh file.
std::string without_quotes(std::string name) {
    for (char& c : name) {
        if (c == '"' || c == '\n') { c = '_'; }
    }
    return name;
}

/// Gmsh 2.2, ASCII. Regions become physical volumes 1, 2, ..; a node set a physical point group of its nodes.
std::string body_msh(const Body& body) {
    const TetMesh& mesh = body.elements;
    std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    auto out = std::back_inserter(text);
    if (!body.node_sets.empty()) {
        fmt::format_to(out, "$PhysicalNames\n{}\n", body.node_sets.size());
        int tag = 0;
        for (const auto& [name, nodes] : body.node_sets) {
            fmt::format_to(out, "0 {} \"{}\"\n", ++tag, without_quotes(name));
        }
        text += "$EndPhysicalNames\n";
    }
    fmt::format_to(out, "$Nodes\n{}\n", mesh.nodes.size());
    for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
        const Vec3& p = mesh.nodes[node];
        fmt::format_to(out, "{} {} {} {}\n", node + 1, p[0], p[1], p[2]);
    }
    fmt::format_to(out, "$EndNodes\n$Elements\n{}\n", mesh.tets.size() + count_of_set_nodes(body));
    std::size_t number = 0;
    for (const auto& t : mesh.tets) {
        const Index region = body.region.empty() ? 0 : body.region[number];
        fmt::format_to(out, "{} 4 2 {} {} {} {} {} {}\n", number + 1, region + 1, region + 1, t[0] + 1,
                       t[1] + 1, t[2] + 1, t[3] + 1);
        ++number;
    }
    int tag = 0;
    for (const auto& [name, nodes] : body.node_sets) {
        ++tag;
        for (const Index node : nodes) {
            fmt::format_to(out, "{0} 15 2 {1} {1} {2}\n", ++number, tag, node + 1);
        }
    }
    return text + "$EndElements\n";
}

} // namespace

Result<void> write_body(const std::string& path, const Body& body) {
    const std::string ending = ending_of(path);
    if (ending == ".vtu") { return write_file(path, body_vtu(body)); }
    if (ending == ".vtk") { return write_file(path, body_vtk(body)); }
    if (ending == ".msh") { return write_file(path, body_msh(body)); }
    return Error{path + ": a body is written as .vtu, .vtk or .msh; end the name with one of these"};
}

} // namespace resect
