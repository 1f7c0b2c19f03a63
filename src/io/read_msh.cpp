// SPDX-License-Identifier: Apache-2.0
#include "io/read_msh.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <optional>

#include "base/index.hpp"
#include "io/refuse.hpp"
#include "io/text_scanner.hpp"
#include "io/vtk_cells.hpp"

namespace resect {

namespace {

/// A group or an entity: its dimension and its tag.
using Tagged = std::pair<std::int64_t, std::int64_t>;

/// The file as it is walked over, and what it has said so far.
struct MshFile {
    TextScanner in;
    bool is_2 = false;                                          // 2.2, else 4.1
    std::map<Tagged, std::string> group_names = {};             // of physical groups
    std::map<Tagged, std::vector<std::int64_t>> groups_of = {}; // [entity] tags of its physical groups (4.1)
    std::vector<std::pair<std::int64_t, Index>> rows = {};      // (tag of a node, its row), by tag
    std::size_t other_elements = 0;
    Body body = {};
};

/// A type of element that is read; all others are skipped.
struct Shape {
    std::int64_t dimension = 0;
    std::size_t nodes = 0;
};

std::optional<Shape> find_shape(std::int64_t type) {
    switch (type) {
    case 15:
        return Shape{0, 1}; // point
    case 1:
        return Shape{1, 2}; // line
    case 2:
        return Shape{2, 3}; // triangle
    case 3:
        return Shape{2, 4}; // quadrangle
    case 4:
        return Shape{3, 4}; // tetrahedron
    default:
        return std::nullopt;
    }
}

void read_format(MshFile& file) {
    const std::string version(file.in.word("the version"));
    if (version != "2.2" && version != "4.1") {
        file.in.refuse("only the versions 2.2 and 4.1 are read; export as one of them (gmsh -format msh22)");
    }
    file.is_2 = version == "2.2";
    if (file.in.integer("the file type") != 0) {
        file.in.refuse("is binary; export it as ASCII (gmsh -setnumber Mesh.Binary 0)");
    }
    file.in.integer("the data size");
}

void read_physical_names(MshFile& file) {
    const std::size_t count = file.in.count("the number of physical names");
    for (std::size_t i = 0; i < count; ++i) {
        const std::int64_t dimension = file.in.integer("a group's dimension");
        const std::int64_t tag = file.in.integer("a group's tag");
        const std::string_view line = file.in.rest_of_line();
        const std::size_t begin = line.find('"');
        const std::size_t end = line.rfind('"');
        if (begin == std::string_view::npos || begin == end) {
            file.in.refuse("the line before has no name in quotes; mend it");
        }
        file.group_names[{dimension, tag}] = line.substr(begin + 1, end - begin - 1);
    }
}

/// Points have a position, others a box; then come the physical groups, and for others what bounds them.
void read_entities(MshFile& file) {
    std::array<std::size_t, 4> counts = {};
    for (std::size_t& count : counts) {
        count = file.in.count("a number of entities");
    }
    for (std::size_t dimension = 0; dimension < counts.size(); ++dimension) {
        for (std::size_t i = 0; i < counts[dimension]; ++i) {
            const std::int64_t tag = file.in.integer("an entity's tag");
            const int coordinates = dimension == 0 ? 3 : 6;
            for (int k = 0; k < coordinates; ++k) {
                file.in.finite_number("an entity's extent");
            }
            const std::size_t count = file.in.count("the number of physical groups");
            std::vector<std::int64_t>& groups = file.groups_of[{std::int64_t(dimension), tag}];
            for (std::size_t k = 0; k < count; ++k) {
                groups.push_back(file.in.integer("a physical group"));
            }
            file.in.rest_of_line();
        }
    }
}

void add_node(MshFile& file, std::int64_t tag) {
    file.rows.emplace_back(tag, static_cast<Index>(file.rows.size()));
    if (file.rows.size() == std::numeric_limits<Index>::max()) {
        file.in.refuse("has too many nodes; coarsen it");
    }
}

void read_position(MshFile& file) {
    Vec3 position = {};
    for (double& x : position) {
        x = file.in.finite_number("a coordinate");
    }
    file.body.elements.nodes.push_back(position);
}

void read_node_block(MshFile& file) {
    const std::int64_t dimension = file.in.integer("a block's dimension");
    file.in.integer("a block's entity");
    const bool parametric = file.in.integer("parametric") != 0;
    const std::size_t count = file.in.count("the number of nodes in a block");
    for (std::size_t i = 0; i < count; ++i) {
        add_node(file, file.in.integer("a node's tag"));
    }
    for (std::size_t i = 0; i < count; ++i) {
        read_position(file);
        for (std::int64_t k = 0; parametric && k < std::min<std::int64_t>(dimension, 3); ++k) {
            file.in.finite_number("a parametric coordinate");
        }
    }
}

void read_nodes(MshFile& file) {
    if (file.is_2) {
        const std::size_t count = file.in.count("the number of nodes");
        for (std::size_t i = 0; i < count; ++i) {
            add_node(file, file.in.integer("a node's number"));
            read_position(file);
        }
    } else {
        const std::size_t blocks = file.in.count("the number of node blocks");
        for (const char* what : {"the number of nodes", "the least node tag", "the greatest node tag"}) {
            file.in.integer(what);
        }
        for (std::size_t i = 0; i < blocks; ++i) {
            read_node_block(file);
        }
    }
    std::sort(file.rows.begin(), file.rows.end());
    const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
    const auto twice = std::adjacent_find(file.rows.begin(), file.rows.end(), same);
    if (twice != file.rows.end()) {
        file.in.refuse(fmt::format("node {} is there twice; number the nodes apart", twice->first));
    }
}

Index read_row(MshFile& file) {
    const std::int64_t tag = file.in.integer("an element's node");
    const auto found = std::lower_bound(file.rows.begin(), file.rows.end(), std::pair(tag, Index{0}));
    if (found == file.rows.end() || found->first != tag) {
        file.in.refuse(fmt::format("an element uses node {}, which is not in $Nodes; mend it", tag));
    }
    return found->second;
}

/// The nodes of a physical group; a group without a name is called by its dimension and tag.
std::vector<Index>& set_of(MshFile& file, Tagged group) {
    static constexpr const char* words[] = {"points", "curve", "surface"};
    const auto name = file.group_names.find(group);
    return file.body
        .node_sets[name != file.group_names.end() ? name->second
                                                  : fmt::format("{} {}", words[group.first], group.second)];
}

/// The rest of an element's line, behind its tags.
void read_element(MshFile& file, const Shape& shape, std::span<const std::int64_t> groups) {
    std::array<Index, 4> nodes = {};
    for (std::size_t i = 0; i < shape.nodes; ++i) {
        nodes[i] = read_row(file);
    }
    if (shape.dimension == 3) {
        file.body.elements.tets.push_back(nodes);
        return;
    }
    ++file.other_elements;
    for (const std::int64_t group : groups) {
        if (group == 0) { continue; }                                               // 2.2 says so of none
        std::vector<Index>& set = set_of(file, {shape.dimension, std::abs(group)}); // minus: turned around
        set.insert(set.end(), nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(shape.nodes));
    }
}

void skip_element(MshFile& file) {
    ++file.other_elements;
    file.in.rest_of_line();
}

void read_elements_2(MshFile& file) {
    const std::size_t count = file.in.count("the number of elements");
    for (std::size_t i = 0; i < count; ++i) {
        file.in.integer("an element's number");
        const std::optional<Shape> shape = find_shape(file.in.integer("an element's type"));
        if (!shape) {
            skip_element(file);
            continue;
        }
        std::vector<std::int64_t> tags(file.in.count("the number of tags"));
        for (std::int64_t& tag : tags) {
            tag = file.in.integer("a tag");
        }
        read_element(file, *shape, std::span(tags).first(tags.empty() ? 0 : 1)); // the first is the group
    }
}

void read_element_block(MshFile& file) {
    const std::int64_t dimension = file.in.integer("a block's dimension");
    const std::int64_t entity = file.in.integer("a block's entity");
    const std::optional<Shape> shape = find_shape(file.in.integer("a block's element type"));
    const std::size_t count = file.in.count("the number of elements in a block");
    if (shape && shape->dimension != dimension) {
        file.in.refuse("a block's dimension is not its type's; mend it");
    }
    const auto groups = file.groups_of.find({dimension, entity});
    for (std::size_t i = 0; i < count; ++i) {
        file.in.integer("an element's tag");
        if (shape) {
            read_element(file, *shape,
                         groups == file.groups_of.end() ? std::span<const std::int64_t>() : groups->second);
        } else {
            skip_element(file);
        }
    }
}

void read_elements(MshFile& file) {
    if (file.rows.empty()) { file.in.refuse("$Elements comes before any node; put $Nodes first"); }
    if (file.is_2) {
        read_elements_2(file);
        return;
    }
    const std::size_t blocks = file.in.count("the number of element blocks");
    for (const char* what : {"the number of elements", "the least element tag", "the greatest element tag"}) {
        file.in.integer(what);
    }
    for (std::size_t i = 0; i < blocks; ++i) {
        read_element_block(file);
    }
}

/// One section with its end.
void read_section(MshFile& file, const std::string& name) {
    if (name == "MeshFormat") {
        read_format(file);
    } else if (name == "PhysicalNames") {
        read_physical_names(file);
    } else if (name == "Entities") {
        read_entities(file);
    } else if (name == "Nodes") {
        read_nodes(file);
    } else if (name == "Elements") {
        read_elements(file);
    } else {
        file.in.skip_past("$End" + name);
        return;
    }
    file.in.expect("$End" + name);
}

} // namespace

Body read_msh(std::string_view text, const std::string& name) {
    MshFile file{TextScanner(text, name)};
    if (!text.starts_with("$MeshFormat")) {
        refuse(name + ":1: does not begin with $MeshFormat; export it as Gmsh 2.2 or 4.1, ASCII");
    }
    while (!file.in.is_at_end()) {
        const std::string section(file.in.word("a section"));
        if (section.front() != '$') { file.in.refuse("expected a section that begins with $; mend it"); }
        read_section(file, section.substr(1));
    }
    for (auto& [set, nodes] : file.body.node_sets) {
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    }
    finish_mesh(file.body, file.other_elements, name);
    return std::move(file.body);
}

} // namespace resect
