// SPDX-License-Identifier: Apache-2.0
#include "io/read_vtk.hpp"

#include <fmt/format.h>

#include "io/number_type.hpp"
#include "io/refuse.hpp"
#include "io/text_scanner.hpp"
#include "io/vtk_cells.hpp"

namespace resect {

namespace {

std::string lower(std::string_view word) {
    std::string text(word);
    for (char& c : text) {
        c = 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return text;
}

/// The file as it is walked over.
struct VtkFile {
    TextScanner in;
    std::string name = {};
    bool binary = false;

    NumberType number_type() {
        const std::string type = lower(in.word("a number type"));
        const auto found = find_number_type(type);
        if (!found) { in.refuse("the number type is not known; write numbers as float, double or int"); }
        return *found;
    }

    std::string_view binary_numbers(std::size_t count, NumberType type, const char* what) {
        in.rest_of_line();
        return in.bytes(count * type.size, what);
    }

    std::vector<double> reals(std::size_t count, NumberType type, const char* what) {
        if (binary) { return decode_reals(binary_numbers(count, type, what), type, true); }
        std::vector<double> values(count);
        for (double& value : values) {
            value = in.finite_number(what);
        }
        return values;
    }

    std::vector<std::int64_t> integers(std::size_t count, NumberType type, const char* what) {
        if (type.kind == NumberKind::real) {
            in.refuse(fmt::format("{} are real numbers; write integers", what));
        }
        if (binary) { return decode_integers(binary_numbers(count, type, what), type, true); }
        std::vector<std::int64_t> values(count);
        for (std::int64_t& value : values) {
            value = in.integer(what);
        }
        return values;
    }
};

constexpr NumberType int32 = {NumberKind::signed_integer, 4};

void read_header(VtkFile& file) {
    if (!file.in.rest_of_line().starts_with("# vtk DataFile Version ")) {
        refuse(file.name + ":1: does not begin as a VTK legacy file; check what it is");
    }
    file.in.rest_of_line(); // the title
    const std::string form = lower(file.in.word("ASCII or BINARY"));
    if (form != "ascii" && form != "binary") { file.in.refuse("must say ASCII or BINARY; mend it"); }
    file.binary = form == "binary";
    if (lower(file.in.word("DATASET")) != "dataset") { file.in.refuse("must say DATASET; mend it"); }
    if (lower(file.in.word("the kind of dataset")) != "unstructured_grid") {
        file.in.refuse("the dataset is no UNSTRUCTURED_GRID; write the tetrahedra as one");
    }
}

void skip_field(VtkFile& file) {
    file.in.word("a field's name");
    const std::size_t arrays = file.in.count("the number of field arrays");
    for (std::size_t array = 0; array < arrays; ++array) {
        file.in.word("an array's name");
        const std::size_t components = file.in.count("the number of components", 1);
        const std::size_t tuples =
            file.in.count("the number of tuples", std::max<std::size_t>(components, 1));
        file.reals(components * tuples, file.number_type(), "a field array");
    }
}

void skip_metadata(VtkFile& file) {
    file.in.rest_of_line();
    while (!file.in.rest_of_line().empty()) {}
}

/// Corners behind each other with the count before each cell (before file version 5).
void read_counted_cells(VtkFile& file, std::size_t cells, std::size_t numbers, VtkCells& read) {
    const std::vector<std::int64_t> list = file.integers(numbers, int32, "cells");
    std::size_t at = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
        const std::int64_t corners = at < list.size() ? list[at] : -1;
        if (corners < 0 || static_cast<std::size_t>(corners) > list.size() - at - 1) {
            refuse(fmt::format("{}: cell {} of CELLS does not fit into its {} numbers; write it again",
                               file.name, cell, numbers));
        }
        const auto first = list.begin() + static_cast<std::ptrdiff_t>(at) + 1;
        read.connectivity.insert(read.connectivity.end(), first, first + corners);
        read.end.push_back(static_cast<std::int64_t>(read.connectivity.size()));
        at += static_cast<std::size_t>(corners) + 1;
    }
}

void read_cells(VtkFile& file, VtkCells& read) {
    const std::size_t first = file.in.count("the number of cells", 1);
    const std::size_t second = file.in.count("the size of CELLS", 1);
    TextScanner behind = file.in;
    behind.rest_of_line();
    if (!behind.continues_with("OFFSETS")) {
        read_counted_cells(file, first, second, read);
        return;
    }
    file.in.expect("OFFSETS"); // file version 5: the starts of the cells and their end
    read.end = file.integers(first, file.number_type(), "cell offsets");
    if (!read.end.empty()) { read.end.erase(read.end.begin()); }
    file.in.expect("CONNECTIVITY");
    read.connectivity = file.integers(second, file.number_type(), "cell corners");
}

} // namespace

Body read_vtk(std::string_view bytes, const std::string& name) {
    VtkFile file{TextScanner(bytes, name), name};
    read_header(file);
    Body body;
    VtkCells cells;
    bool has_types = false;
    while (!has_types) {
        const std::string key = lower(file.in.word("CELL_TYPES"));
        if (key == "points") {
            const std::size_t count = file.in.count("the number of points", 3);
            add_points(body.elements, file.reals(3 * count, file.number_type(), "coordinates"),
                       name + ": POINTS");
        } else if (key == "cells") {
            read_cells(file, cells);
        } else if (key == "cell_types") {
            cells.type = file.integers(file.in.count("the number of cell types", 2), int32, "cell types");
            has_types = true;
        } else if (key == "field") {
            skip_field(file);
        } else if (key == "metadata") {
            skip_metadata(file);
        } else {
            file.in.refuse("expected POINTS, CELLS or CELL_TYPES; mend it");
        }
    }
    finish_mesh(body, add_tets(body.elements, cells, 0, name + ": CELLS"), name);
    return body;
}

} // namespace resect
