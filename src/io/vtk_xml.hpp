// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/bytes.hpp"

namespace resect {

/// One DataArray of a VTK XML file.
struct VtkArray {
    std::string name = {};
    std::string_view type = {}; // VTK's name of the number type
    std::size_t components = 1;
    std::string bytes = {};
};

/// "PointData", "CellData", "Points", "Cells", "Polys" with their arrays.
struct VtkSection {
    std::string_view name = {};
    std::vector<VtkArray> arrays = {};
};

constexpr std::string_view vtk_type(const float&) { return "Float32"; }
constexpr std::string_view vtk_type(const double&) { return "Float64"; }
constexpr std::string_view vtk_type(const std::uint8_t&) { return "UInt8"; }
constexpr std::string_view vtk_type(const std::int32_t&) { return "Int32"; }
constexpr std::string_view vtk_type(const std::int64_t&) { return "Int64"; }

template <class T>
VtkArray vtk_array(std::string name, std::span<const T> values) {
    return {std::move(name), vtk_type(T{}), 1, bytes_of(values)};
}

template <class T, std::size_t N>
VtkArray vtk_array(std::string name, std::span<const std::array<T, N>> values) {
    return {std::move(name), vtk_type(T{}), N, bytes_of(values)};
}

/// The "Cells" or "Polys" arrays of cells that all have N corners, without their types.
template <std::size_t N>
std::vector<VtkArray> vtk_cells(std::span<const std::array<std::int32_t, N>> cells) {
    VtkArray connectivity = vtk_array("connectivity", cells);
    connectivity.components = 1;
    std::vector<std::int64_t> offsets(cells.size());
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        offsets[cell] = static_cast<std::int64_t>((cell + 1) * N);
    }
    return {std::move(connectivity), vtk_array("offsets", std::span<const std::int64_t>(offsets))};
}

/// The "Cells" of an unstructured grid of tets.
VtkSection vtk_tets(std::span<const std::array<std::int32_t, 4>> tets);

/// A file of one piece with appended raw data. `piece_counts` are the attributes of Piece.
std::string vtk_xml(std::string_view dataset, std::string_view piece_counts,
                    std::span<const VtkSection> sections);

/// Text as the value of an XML attribute.
std::string xml_escaped(std::string_view text);

} // namespace resect
