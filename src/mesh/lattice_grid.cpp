// SPDX-License-Identifier: Apache-2.0
#include "mesh/lattice_grid.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/index.hpp"

namespace resect {
namespace {

constexpr double most_cells = 50e6;
constexpr double margin = 1.5; // cells around the bounds

/// The four tets around the line from a cell's centre to that of the next cell along `axis`.
std::array<Tet, 4> tets_between(const LatticeGrid& grid, std::array<Index, 3> cell, std::size_t axis) {
    const Index from = grid.centre(cell[0], cell[1], cell[2]);
    ++cell[axis];
    const Index to = grid.centre(cell[0], cell[1], cell[2]);
    std::array<Index, 4> face = {};
    for (std::size_t k = 0; k < 4; ++k) {
        std::array<Index, 3> at = cell;
        at[(axis + 1) % 3] += k == 1 || k == 2 ? 1 : 0;
        at[(axis + 2) % 3] += k >= 2 ? 1 : 0;
        face[k] = grid.corner(at[0], at[1], at[2]);
    }
    std::array<Tet, 4> tets = {};
    for (std::size_t k = 0; k < 4; ++k) {
        tets[k] = {face[k], face[(k + 1) % 4], from, to};
    }
    return tets;
}

} // namespace

Vec3 LatticeGrid::position(Index point) const {
    const bool is_corner = point < corner_count();
    const Index n = is_corner ? 1 : 0;
    const Index rank = is_corner ? point : point - corner_count();
    const double shift = is_corner ? 0 : 0.5;
    const Index x = rank % (cells[0] + n);
    const Index column = rank / (cells[0] + n);
    const Index y = column % (cells[1] + n);
    const Index z = column / (cells[1] + n);
    return origin + spacing * Vec3{x + shift, y + shift, z + shift};
}

Fault make_lattice_grid(const Box& bounds, const LatticePlan& plan, LatticeGrid& grid) {
    grid.spacing = plan.spacing;
    std::array<double, 3> cells = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.origin[axis] = bounds.lo[axis] - plan.spacing * (margin + plan.offset[axis]);
        cells[axis] = std::ceil((bounds.hi[axis] - grid.origin[axis]) / plan.spacing + margin);
    }
    const double count = cells[0] * cells[1] * cells[2];
    if (!(count <= most_cells)) {
        return Error{
            fmt::format("a lattice of spacing {:.4g} m has {:.3g} cells over the bounds, above {:.3g}: take "
                        "a larger spacing or fewer elements",
                        plan.spacing, count, most_cells)};
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.cells[axis] = static_cast<Index>(cells[axis]);
    }
    return {};
}

Fault check_value(double value, const Vec3& p, const Box& bounds) {
    if (!std::isfinite(value)) {
        return Error{
            fmt::format("the shape is not finite at ({:.4g}, {:.4g}, {:.4g}) m: {}; mend the function", p[0],
                        p[1], p[2], value)};
    }
    if (value < 0 && !is_inside(bounds, p)) {
        return Error{fmt::format(
            "the body reaches out of its bounds at ({:.4g}, {:.4g}, {:.4g}) m: enlarge the bounds", p[0],
            p[1], p[2])};
    }
    return {};
}

Fault sample_shape(const LatticeGrid& grid, const Shape& shape, const Box& bounds,
                   std::vector<double>& values) {
    values.resize(row(grid.point_count()));
    for (Index point = 0; point < grid.point_count(); ++point) {
        const Vec3 p = grid.position(point);
        const double value = shape(p);
        if (Fault fault = check_value(value, p, bounds)) { return fault; }
        values[row(point)] = value;
    }
    return {};
}

std::vector<Tet> find_lattice_tets(const LatticeGrid& grid, const std::vector<double>& values, double reach) {
    std::vector<Tet> found;
    const auto is_near = [&](Index point) { return values[row(point)] < reach; };
    const auto append_near = [&](const std::array<Index, 3>& cell, std::size_t axis) {
        if (cell[axis] + 1 == grid.cells[axis]) { return; }
        for (const Tet& tet : tets_between(grid, cell, axis)) {
            if (std::any_of(tet.begin(), tet.end(), is_near)) { found.push_back(tet); }
        }
    };
    for (Index z = 0; z < grid.cells[2]; ++z) {
        for (Index y = 0; y < grid.cells[1]; ++y) {
            for (Index x = 0; x < grid.cells[0]; ++x) {
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    append_near({x, y, z}, axis);
                }
            }
        }
    }
    return found;
}

} // namespace resect
