// SPDX-License-Identifier: Apache-2.0
#include "io/vtk_cells.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "io/refuse.hpp"

namespace resect {

void add_points(TetMesh& mesh, std::span<const double> coordinates, const std::string& where) {
    constexpr std::size_t most = std::numeric_limits<Index>::max();
    if (coordinates.size() % 3 != 0 || coordinates.size() / 3 > most - mesh.nodes.size()) {
        refuse(fmt::format("{}: {} coordinates do not make points of three, or make too many; write it again",
                           where, coordinates.size()));
    }
    for (std::size_t i = 0; i < coordinates.size(); i += 3) {
        const Vec3 point = {coordinates[i], coordinates[i + 1], coordinates[i + 2]};
        for (const double x : point) {
            if (!std::isfinite(x)) {
                refuse(fmt::format("{}: point {} has the coordinate {}; it must be finite", where,
                                   mesh.nodes.size(), x));
            }
        }
        mesh.nodes.push_back(point);
    }
}

std::size_t add_tets(TetMesh& mesh, const VtkCells& cells, std::size_t first_node, const std::string& where) {
    constexpr std::int64_t tetra = 10; // VTK_TETRA
    const auto points = static_cast<std::int64_t>(mesh.nodes.size() - first_node);
    if (cells.end.size() != cells.type.size()) {
        refuse(fmt::format("{}: {} cells have {} types; write it again", where, cells.end.size(),
                           cells.type.size()));
    }
    std::size_t others = 0;
    std::int64_t begin = 0;
    for (std::size_t cell = 0; cell < cells.end.size(); ++cell) {
        const std::int64_t end = cells.end[cell];
        if (end < begin || end > static_cast<std::int64_t>(cells.connectivity.size())) {
            refuse(fmt::format("{}: cell {} ends at corner {} of {}; write it again", where, cell, end,
                               cells.connectivity.size()));
        }
        const auto corners =
            std::span(cells.connectivity)
                .subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
        begin = end;
        if (cells.type[cell] != tetra) {
            ++others;
            continue;
        }
        if (corners.size() != 4) {
            refuse(fmt::format("{}: cell {} is a tetrahedron of {} points; it needs 4", where, cell,
                               corners.size()));
        }
        std::array<Index, 4> tet = {};
        for (std::size_t corner = 0; corner < 4; ++corner) {
            if (corners[corner] < 0 || corners[corner] >= points) {
                refuse(fmt::format("{}: cell {} uses point {} of {}; points count from 0", where, cell,
                                   corners[corner], points));
            }
            tet[corner] = static_cast<Index>(first_node) + static_cast<Index>(corners[corner]);
        }
        mesh.tets.push_back(tet);
    }
    return others;
}

void finish_mesh(Body& body, std::size_t other_cells, const std::string& file) {
    if (body.elements.tets.empty()) {
        refuse(
            fmt::format("{}: holds no linear tetrahedra, but {} other cells; mesh the volume with tetrahedra "
                        "of four nodes",
                        file, other_cells));
    }
    if (other_cells > 0) {
        body.notes.push_back(fmt::format("{} cells that are no linear tetrahedra are left out", other_cells));
    }
}

} // namespace resect
