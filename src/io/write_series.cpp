// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <iterator>

#include "resect/files.hpp"

#include "io/file.hpp"
#include "io/vtk_xml.hpp"

namespace resect {

Result<void> write_series(const std::string& path, std::span<const SeriesEntry> entries) {
    if (ending_of(path) != ".pvd") { return Error{path + ": a series is written as .pvd; end the name so"}; }
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
    auto out = std::back_inserter(text);
    for (const SeriesEntry& entry : entries) {
        fmt::format_to(out, "<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", entry.time,
                       xml_escaped(entry.file));
    }
    return write_file(path, text + "</Collection>\n</VTKFile>\n");
}

} // namespace resect
