// SPDX-License-Identifier: Apache-2.0
#include "io/vtk_xml.hpp"

#include <fmt/format.h>
#include <iterator>

namespace resect {

VtkSection vtk_tets(std::span<const std::array<std::int32_t, 4>> tets) {
    VtkSection section{"Cells", vtk_cells(tets)};
    const std::vector<std::uint8_t> types(tets.size(), 10); // VTK_TETRA
    section.arrays.push_back(vtk_array("types", std::span<const std::uint8_t>(types)));
    return section;
}

std::string xml_escaped(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        switch (c) {
        case '&':
            escaped += "&amp;";
            break;
        case '<':
            escaped += "&lt;";
            break;
        case '>':
            escaped += "&gt;";
            break;
        case '"':
            escaped += "&quot;";
            break;
        default:
            escaped += c;
        }
    }
    return escaped;
}

std::string vtk_xml(std::string_view dataset, std::string_view piece_counts,
                    std::span<const VtkSection> sections) {
    std::string xml;
    std::string data;
    auto out = std::back_inserter(xml);
    fmt::format_to(
        out,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n<{0}>\n<Piece {1}>\n",
        dataset, piece_counts);
    for (const VtkSection& section : sections) {
        fmt::format_to(out, "<{}>\n", section.name);
        for (const VtkArray& array : section.arrays) {
            const std::string width =
                array.components == 1 ? "" : fmt::format("NumberOfComponents=\"{}\" ", array.components);
            fmt::format_to(out, "<DataArray type=\"{}\" Name=\"{}\" {}format=\"appended\" offset=\"{}\"/>\n",
                           array.type, xml_escaped(array.name), width, data.size());
            append_bytes(data, std::uint64_t{array.bytes.size()});
            data += array.bytes;
        }
        fmt::format_to(out, "</{}>\n", section.name);
    }
    fmt::format_to(out, "</Piece>\n</{}>\n<AppendedData encoding=\"raw\">\n_", dataset);
    return xml + data + "\n</AppendedData>\n</VTKFile>\n";
}

} // namespace resect
