// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "mesh/fault.hpp"
#include "mesh/tet.hpp"

namespace resect {

/// Negative inside, about the distance in metres near the surface.
using Shape = std::function<double(Vec3)>;

/// Where a lattice lies and how much finer its material is near the boundary.
struct LatticePlan {
    double spacing = 0; // m, the edge of a cube
    Vec3 offset = {};   // by which the lattice is shifted back, in spacings
    int refine = 1;
};

/// A body-centred cubic lattice over a box, with room around it. Points are the corners of the cubes, x
/// fastest, then their centres.
struct LatticeGrid {
    Vec3 origin = {};
    double spacing = 0;
    std::array<Index, 3> cells = {};

    Index corner(Index x, Index y, Index z) const { return x + (cells[0] + 1) * (y + (cells[1] + 1) * z); }
    Index centre(Index x, Index y, Index z) const {
        return corner_count() + x + cells[0] * (y + cells[1] * z);
    }
    Index corner_count() const { return (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1); }
    Index point_count() const { return corner_count() + cells[0] * cells[1] * cells[2]; }
    Vec3 position(Index point) const;
};
Fault make_lattice_grid(const Box& bounds, const LatticePlan& plan, LatticeGrid& grid);

/// Refuses a value of the shape at p that is not finite, or negative outside the bounds.
Fault check_value(double value, const Vec3& p, const Box& bounds);

/// [point of the grid] The shape's value, checked.
Fault sample_shape(const LatticeGrid& grid, const Shape& shape, const Box& bounds,
                   std::vector<double>& values);

/// The lattice's tets, as points of the grid, that have a corner with a value below `reach`, by cell.
std::vector<Tet> find_lattice_tets(const LatticeGrid& grid, const std::vector<double>& values, double reach);

} // namespace resect
