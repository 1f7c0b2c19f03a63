// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fmt/format.h>

#include "base/index.hpp"
#include "mesh/tet.hpp"

namespace resect {
namespace {

using Cell = std::array<Index, 3>;

constexpr double most_tets = 50e6;

/// A box of cells; corners are numbered x fastest, then y, then z, and so are cells.
struct Grid {
    Vec3 size;
    Cell cells;

    Index corner(const Cell& at) const { return at[0] + (cells[0] + 1) * (at[1] + (cells[1] + 1) * at[2]); }
    Index cell(const Cell& at) const { return at[0] + cells[0] * (at[1] + cells[1] * at[2]); }
    Index corner_count() const { return (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1); }
};

/// Calls visit(cell) for lo <= cell < hi, x fastest.
template <class Visit>
void for_each_cell(const Cell& hi, const Visit& visit) {
    for (Index z = 0; z < hi[2]; ++z) {
        for (Index y = 0; y < hi[1]; ++y) {
            for (Index x = 0; x < hi[0]; ++x) {
                visit(Cell{x, y, z});
            }
        }
    }
}

Cell step(Cell cell, std::size_t axis, Index by = 1) {
    cell[axis] += by;
    return cell;
}

/// The lowest corner of a cell, `shift` cells further along each axis.
Vec3 point_of(const Grid& grid, const Cell& at, double shift) {
    Vec3 p = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        p[axis] = grid.size[axis] * (at[axis] + shift) / grid.cells[axis];
    }
    return p;
}

void append_corners(const Grid& grid, TetMesh& mesh) {
    const auto append = [&](const Cell& at) { mesh.nodes.push_back(point_of(grid, at, 0)); };
    for_each_cell({grid.cells[0] + 1, grid.cells[1] + 1, grid.cells[2] + 1}, append);
}

void append_centres(const Grid& grid, TetMesh& mesh) {
    for_each_cell(grid.cells, [&](const Cell& at) { mesh.nodes.push_back(point_of(grid, at, 0.5)); });
}

/// Kuhn's six tets: paths from the lowest to the highest corner, one for each order of the axes. An odd order
/// turns the tet over, which the swap of its last corners undoes.
void append_six_tets(const Grid& grid, const Cell& cell, TetMesh& mesh) {
    constexpr std::size_t orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    constexpr bool odd[6] = {false, true, true, false, false, true};
    for (std::size_t path = 0; path < 6; ++path) {
        const Cell first = step(cell, orders[path][0]);
        const Cell second = step(first, orders[path][1]);
        const Cell last = step(second, orders[path][2]);
        Tet tet = {grid.corner(cell), grid.corner(first), grid.corner(second), grid.corner(last)};
        if (odd[path]) { std::swap(tet[2], tet[3]); }
        mesh.tets.push_back(tet);
    }
}

/// The corners of the face where a cell begins along `axis`, in the turning sense of that axis.
std::array<Index, 4> low_face(const Grid& grid, const Cell& cell, std::size_t axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    return {grid.corner(cell), grid.corner(step(cell, u)), grid.corner(step(step(cell, u), v)),
            grid.corner(step(cell, v))};
}

/// The tets at the face where a cell begins along `axis`: four around the line between the centres on its two
/// sides, or two on the one side where the block ends. `cell` may lie one beyond the last.
void append_face_tets(const Grid& grid, const Cell& cell, std::size_t axis, TetMesh& mesh) {
    const auto q = low_face(grid, cell, axis);
    const auto centre = [&](const Cell& at) { return grid.corner_count() + grid.cell(at); };
    if (cell[axis] == 0) {
        mesh.tets.push_back({q[0], q[1], q[2], centre(cell)});
        mesh.tets.push_back({q[0], q[2], q[3], centre(cell)});
        return;
    }
    const Index below = centre(step(cell, axis, -1));
    if (cell[axis] == grid.cells[axis]) {
        mesh.tets.push_back({q[0], q[2], q[1], below});
        mesh.tets.push_back({q[0], q[3], q[2], below});
        return;
    }
    for (std::size_t k = 0; k < 4; ++k) {
        mesh.tets.push_back({q[k], q[(k + 1) % 4], below, centre(cell)});
    }
}

void append_bcc_tets(const Grid& grid, TetMesh& mesh) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for_each_cell(step(grid.cells, axis),
                      [&](const Cell& cell) { append_face_tets(grid, cell, axis, mesh); });
    }
}

bool is_length(double size) { return std::isfinite(size) && size > 0; }

} // namespace

Result<Body> make_block(Vec3 size, std::array<Index, 3> cells, Split split) {
    if (!is_length(size[0]) || !is_length(size[1]) || !is_length(size[2])) {
        return Error{fmt::format("block size ({}, {}, {}) m: each length must be finite and above 0", size[0],
                                 size[1], size[2])};
    }
    if (cells[0] < 1 || cells[1] < 1 || cells[2] < 1) {
        return Error{fmt::format("block cells ({}): each number must be at least 1", fmt::join(cells, ", "))};
    }
    const double tets = (split == Split::six ? 6.0 : 12.0) * cells[0] * cells[1] * cells[2];
    if (tets > most_tets) {
        return Error{
            fmt::format("block cells ({}) make {:.3g} tets; at most {:.3g} are made: use fewer cells",
                        fmt::join(cells, ", "), tets, most_tets)};
    }
    const Grid grid = {size, cells};
    Body body;
    append_corners(grid, body.elements);
    if (split == Split::six) {
        for_each_cell(cells, [&](const Cell& cell) { append_six_tets(grid, cell, body.elements); });
    } else {
        append_centres(grid, body.elements);
        append_bcc_tets(grid, body.elements);
    }
    return body;
}

} // namespace resect
