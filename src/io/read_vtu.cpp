// SPDX-License-Identifier: Apache-2.0
#include "io/read_vtu.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <pugixml.hpp>

#include "io/base64.hpp"
#include "io/file.hpp"
#include "io/number_type.hpp"
#include "io/refuse.hpp"
#include "io/text_scanner.hpp"
#include "io/vtk_cells.hpp"

namespace resect {

namespace {

/// The XML without the appended data, which is no XML where it is raw.
struct VtuFile {
    std::string name = {};
    std::string xml = {};
    std::string_view appended = {};
    bool appended_is_raw = true;
    bool big_endian = false;
    std::size_t header_size = 4; // bytes of the length before binary data
    pugi::xml_document document = {};

    [[noreturn]] void refuse_array(const pugi::xml_node& array, std::string_view why) const {
        refuse(fmt::format("{}: array '{}' {}", name, array.attribute("Name").value(), why));
    }
    pugi::xml_node grid() const { return document.child("VTKFile").child("UnstructuredGrid"); }
};

/// Cuts the appended data off.
void split_appended(std::string_view bytes, VtuFile& file) {
    const std::size_t tag = bytes.find("<AppendedData");
    if (tag == std::string_view::npos) {
        file.xml = bytes;
        return;
    }
    const std::size_t tag_end = bytes.find('>', tag);
    const std::size_t mark = bytes.find('_', std::min(tag_end, bytes.size()));
    const std::size_t end = bytes.rfind("</AppendedData>");
    if (mark == std::string_view::npos || end == std::string_view::npos || end < mark) {
        refuse(file.name +
               ": the appended data has no beginning or no end; the file was cut off: write it again");
    }
    file.xml = std::string(bytes.substr(0, tag)) + "</VTKFile>";
    file.appended = bytes.substr(mark + 1, end - mark - 1);
    const std::string_view attributes = bytes.substr(tag, tag_end - tag);
    file.appended_is_raw = attributes.find("base64") == std::string_view::npos;
}

std::size_t line_of(std::string_view text, std::ptrdiff_t offset) {
    const auto end = text.begin() + std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(text));
    return static_cast<std::size_t>(std::count(text.begin(), end, '\n')) + 1;
}

void parse_xml(VtuFile& file) {
    const pugi::xml_parse_result parsed = file.document.load_buffer(file.xml.data(), file.xml.size());
    if (!parsed) {
        refuse(fmt::format("{}:{}: not XML: {}; write it again", file.name, line_of(file.xml, parsed.offset),
                           parsed.description()));
    }
    const pugi::xml_node root = file.document.child("VTKFile");
    const std::string_view type = root.attribute("type").value();
    if (!file.grid()) {
        refuse(fmt::format("{}: is no UnstructuredGrid{}{}; write the tetrahedra as one", file.name,
                           type.empty() ? "" : " but ", type));
    }
    if (const pugi::xml_attribute compressor = root.attribute("compressor")) {
        refuse(fmt::format(
            "{}: is compressed by {}; write it without compression (ParaView: Compressor Type None, "
            "meshio: compression=None)",
            file.name, compressor.value()));
    }
    file.big_endian = std::string_view(root.attribute("byte_order").value()) == "BigEndian";
    const std::string_view header = root.attribute("header_type").as_string("UInt32");
    if (header != "UInt32" && header != "UInt64") {
        refuse(fmt::format("{}: header_type is {}; it must be UInt32 or UInt64", file.name, header));
    }
    file.header_size = header == "UInt64" ? 8 : 4;
}

void open_vtu(std::string_view bytes, const std::string& name, VtuFile& file) {
    file.name = name;
    split_appended(bytes, file);
    parse_xml(file);
}

std::uint64_t length_at(std::string_view data, const VtuFile& file) {
    const NumberType type = {NumberKind::unsigned_integer, file.header_size};
    return static_cast<std::uint64_t>(
        decode_integers(data.substr(0, file.header_size), type, file.big_endian).front());
}

/// The bytes behind their length, which may not reach beyond what is there.
std::string_view behind_length(std::string_view data, const VtuFile& file, const pugi::xml_node& array) {
    if (data.size() < file.header_size) { file.refuse_array(array, "has no data; write the file again"); }
    const std::uint64_t length = length_at(data, file);
    data.remove_prefix(file.header_size);
    if (length > data.size()) {
        file.refuse_array(array,
                          fmt::format("claims {} bytes where {} are left; the file was cut off or is wrong",
                                      length, data.size()));
    }
    return data.substr(0, static_cast<std::size_t>(length));
}

std::string decoded(std::string_view text, const VtuFile& file, const pugi::xml_node& array) {
    const std::optional<std::string> header = decode_base64(text, file.header_size);
    if (!header || header->size() < file.header_size) {
        file.refuse_array(array, "is not base64; write the file again");
    }
    const std::uint64_t length = length_at(*header, file);
    if (length > text.size()) {
        file.refuse_array(array, "claims more bytes than are there; it was cut off");
    }
    const std::optional<std::string> all =
        decode_base64(text, file.header_size + static_cast<std::size_t>(length));
    if (!all) { file.refuse_array(array, "is not base64; write the file again"); }
    return std::string(behind_length(*all, file, array));
}

/// The bytes of an array that is not ASCII.
std::string binary_data(const VtuFile& file, const pugi::xml_node& array) {
    const std::string_view format = array.attribute("format").value();
    if (format == "binary") { return decoded(array.text().get(), file, array); }
    if (format != "appended") {
        file.refuse_array(array, fmt::format("has the format '{}'; write ascii, binary or appended", format));
    }
    const std::uint64_t offset = array.attribute("offset").as_ullong(file.appended.size());
    if (offset >= file.appended.size()) {
        file.refuse_array(array, "begins beyond the appended data; the file was cut off or is wrong");
    }
    const std::string_view data = file.appended.substr(static_cast<std::size_t>(offset));
    return file.appended_is_raw ? std::string(behind_length(data, file, array)) : decoded(data, file, array);
}

NumberType type_of(const VtuFile& file, const pugi::xml_node& array) {
    const std::string_view type = array.attribute("type").value();
    const auto found = find_number_type(type);
    if (!found) { file.refuse_array(array, fmt::format("is of the type '{}'; write numbers", type)); }
    return *found;
}

bool is_ascii(const pugi::xml_node& array) {
    return std::string_view(array.attribute("format").as_string("ascii")) == "ascii";
}

TextScanner text_of(const VtuFile& file, const pugi::xml_node& array) {
    const pugi::xml_node text = array.first_child();
    return {array.text().get(), file.name,
            line_of(file.xml, text ? text.offset_debug() : array.offset_debug())};
}

std::vector<double> reals(const VtuFile& file, const pugi::xml_node& array) {
    if (!is_ascii(array)) {
        return decode_reals(binary_data(file, array), type_of(file, array), file.big_endian);
    }
    std::vector<double> values;
    TextScanner in = text_of(file, array);
    while (!in.is_at_end()) {
        values.push_back(in.finite_number(array.attribute("Name").value()));
    }
    return values;
}

std::vector<std::int64_t> integers(const VtuFile& file, const pugi::xml_node& array) {
    const NumberType type = type_of(file, array);
    if (type.kind == NumberKind::real) { file.refuse_array(array, "holds real numbers; write integers"); }
    if (!is_ascii(array)) { return decode_integers(binary_data(file, array), type, file.big_endian); }
    std::vector<std::int64_t> values;
    TextScanner in = text_of(file, array);
    while (!in.is_at_end()) {
        values.push_back(in.integer(array.attribute("Name").value()));
    }
    return values;
}

std::vector<std::int64_t> cell_array(const VtuFile& file, const pugi::xml_node& piece, const char* name) {
    const pugi::xml_node array = piece.child("Cells").find_child_by_attribute("DataArray", "Name", name);
    if (!array) { refuse(fmt::format("{}: Cells has no array '{}'; write the file again", file.name, name)); }
    return integers(file, array);
}

std::size_t components_of(const pugi::xml_node& array) {
    return array.attribute("NumberOfComponents").as_uint(1);
}

void add_node_sets(const VtuFile& file, const pugi::xml_node& piece, std::size_t first_node, Body& body) {
    for (const pugi::xml_node& array : piece.child("PointData").children("DataArray")) {
        const bool is_set =
            std::string_view(array.attribute("type").value()) == "UInt8" && components_of(array) == 1;
        if (!is_set) { continue; }
        const std::vector<std::int64_t> inside = integers(file, array);
        if (inside.size() != body.elements.nodes.size() - first_node) {
            file.refuse_array(array, fmt::format("has {} values for {} points; write the file again",
                                                 inside.size(), body.elements.nodes.size() - first_node));
        }
        std::vector<Index>& nodes = body.node_sets[array.attribute("Name").value()];
        for (std::size_t i = 0; i < inside.size(); ++i) {
            if (inside[i] != 0) { nodes.push_back(static_cast<Index>(first_node + i)); }
        }
    }
}

/// Gives the number of cells left out.
std::size_t add_piece(const VtuFile& file, const pugi::xml_node& piece, Body& body) {
    const std::size_t first_node = body.elements.nodes.size();
    const pugi::xml_node points = piece.child("Points").child("DataArray");
    if (!points) { refuse(file.name + ": a Piece has no Points; write the file again"); }
    if (components_of(points) != 3) { file.refuse_array(points, "must have three components"); }
    add_points(body.elements, reals(file, points), file.name + ": Points");
    const std::size_t count = body.elements.nodes.size() - first_node;
    if (piece.attribute("NumberOfPoints").as_ullong(count) != count) {
        refuse(fmt::format("{}: NumberOfPoints is {}, but there are {}; the file was cut off or is wrong",
                           file.name, piece.attribute("NumberOfPoints").value(), count));
    }
    const VtkCells cells = {cell_array(file, piece, "connectivity"), cell_array(file, piece, "offsets"),
                            cell_array(file, piece, "types")};
    if (piece.attribute("NumberOfCells").as_ullong(cells.type.size()) != cells.type.size()) {
        refuse(fmt::format("{}: NumberOfCells is {}, but there are {}; the file was cut off or is wrong",
                           file.name, piece.attribute("NumberOfCells").value(), cells.type.size()));
    }
    add_node_sets(file, piece, first_node, body);
    return add_tets(body.elements, cells, first_node, file.name + ": Cells");
}

std::vector<Vec3> vectors_of(std::string_view bytes, const std::string& path, const std::string& name) {
    VtuFile file;
    open_vtu(bytes, path, file);
    TetMesh values; // its nodes: as finite and as many as points must be
    for (const pugi::xml_node& piece : file.grid().children("Piece")) {
        const pugi::xml_node array =
            piece.child("PointData").find_child_by_attribute("DataArray", "Name", name.c_str());
        if (!array) { refuse(fmt::format("{}: has no point array '{}'; name one that it has", path, name)); }
        if (components_of(array) != 3) { file.refuse_array(array, "must have three components"); }
        add_points(values, reals(file, array), fmt::format("{}: array '{}'", path, name));
    }
    return values.nodes;
}

} // namespace

Body read_vtu(std::string_view bytes, const std::string& name) {
    VtuFile file;
    open_vtu(bytes, name, file);
    Body body;
    std::size_t others = 0;
    for (const pugi::xml_node& piece : file.grid().children("Piece")) {
        others += add_piece(file, piece, body);
    }
    finish_mesh(body, others, name);
    return body;
}

Result<std::vector<Vec3>> read_vtu_vectors(const std::string& path, const std::string& array) {
    if (ending_of(path) != ".vtu") {
        return Error{path + ": point arrays are read from .vtu files; write one"};
    }
    return read_or_refuse([&] { return vectors_of(read_file(path), path, array); });
}

} // namespace resect
