// SPDX-License-Identifier: Apache-2.0
#include "io/copies_vtu.hpp"

#include <fmt/format.h>

#include "base/assert.hpp"
#include "io/vtk_xml.hpp"

namespace resect {

std::string copies_vtu(const Nodes& nodes, const Copies& copies, std::span<const double> von_mises) {
    RESECT_ASSERT(nodes.displacement.size() == nodes.rest.size());
    RESECT_ASSERT(von_mises.size() == copies.node.size());
    const VtkSection sections[] = {
        {"PointData",
         {vtk_array("displacement", nodes.displacement), vtk_array("velocity", nodes.velocity),
          vtk_array("mass", nodes.mass), vtk_array("fixed", nodes.fixed),
          vtk_array("reference_node", nodes.reference)}},
        {"CellData",
         {vtk_array("fraction", copies.fraction), vtk_array("element", copies.element),
          vtk_array("piece", copies.piece), vtk_array("von_mises", von_mises)}},
        {"Points", {vtk_array("Points", nodes.rest)}},
        vtk_tets(copies.node),
    };
    const std::string counts =
        fmt::format("NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", nodes.rest.size(), copies.node.size());
    return vtk_xml("UnstructuredGrid", counts, sections);
}

} // namespace resect
