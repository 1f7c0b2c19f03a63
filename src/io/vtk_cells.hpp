// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "resect/body.hpp"

namespace resect {

/// Cells of a VTK grid as its files hold them.
struct VtkCells {
    std::vector<std::int64_t> connectivity = {}; // corners of all cells behind each other
    std::vector<std::int64_t> end = {};          // [cell] where its corners end in connectivity
    std::vector<std::int64_t> type = {};         // [cell]
};

/// Adds points given by three coordinates each. Refuses what is not finite or not whole points. `where` is
/// the file and the part of it.
void add_points(TetMesh& mesh, std::span<const double> coordinates, const std::string& where);

/// Adds the tets among the cells; their corners count from `first_node`. Gives the number of other cells.
std::size_t add_tets(TetMesh& mesh, const VtkCells& cells, std::size_t first_node, const std::string& where);

/// Refuses a mesh without tets, and notes cells that were left out.
void finish_mesh(Body& body, std::size_t other_cells, const std::string& file);

} // namespace resect
