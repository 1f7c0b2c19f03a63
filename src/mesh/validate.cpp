// SPDX-License-Identifier: Apache-2.0
#include "mesh/validate.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "mesh/adjacency.hpp"
#include "mesh/fault.hpp"

namespace resect {
namespace {

/// Six times the volume against the cube of the longest edge, below which single precision sees no volume.
constexpr double flat_share = 1e-6;

std::string name_tet(const TetMesh& mesh, Index tet) {
    return fmt::format("tet {} (nodes {})", tet, fmt::join(mesh.tets[row(tet)], " "));
}

Fault find_size_fault(const TetMesh& mesh) {
    constexpr std::size_t most = 500'000'000; // face slots are 32-bit
    if (mesh.nodes.empty() || mesh.tets.empty()) {
        return Error{fmt::format("the mesh is empty: {} nodes, {} tets; give at least one tet",
                                 mesh.nodes.size(), mesh.tets.size())};
    }
    if (mesh.nodes.size() > most || mesh.tets.size() > most) {
        return Error{fmt::format("the mesh is too large: {} nodes, {} tets; at most {} of each are held",
                                 mesh.nodes.size(), mesh.tets.size(), most)};
    }
    return {};
}

Fault find_node_fault(const TetMesh& mesh) {
    for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
        const Vec3& p = mesh.nodes[node];
        if (is_finite(p)) { continue; }
        return Error{
            fmt::format("node {} has a coordinate that is not finite: ({}, {}, {}); write the mesh anew",
                        node, p[0], p[1], p[2])};
    }
    return {};
}

Fault find_corner_fault(const TetMesh& mesh, Index tet) {
    const Index node_count = static_cast<Index>(mesh.nodes.size());
    Tet corners = mesh.tets[row(tet)];
    std::sort(corners.begin(), corners.end());
    if (corners.front() < 0 || corners.back() >= node_count) {
        const Index wrong = corners.front() < 0 ? corners.front() : corners.back();
        return Error{fmt::format("{} names node {}, but rows run from 0 to {}; check the numbering",
                                 name_tet(mesh, tet), wrong, node_count - 1)};
    }
    const auto twin = std::adjacent_find(corners.begin(), corners.end());
    if (twin != corners.end()) {
        return Error{
            fmt::format("{} repeats node {}: degenerate; remove the element", name_tet(mesh, tet), *twin)};
    }
    return {};
}

double longest_edge(const TetMesh& mesh, const Tet& tet) {
    double longest = 0;
    for (const auto& [a, b] : edge_corners) {
        longest = std::max(longest, length(mesh.nodes[row(tet[row(a)])] - mesh.nodes[row(tet[row(b)])]));
    }
    return longest;
}

Fault find_flat_fault(const TetMesh& mesh, Index tet) {
    const double volume = signed_volume(mesh, mesh.tets[row(tet)]);
    const double edge = longest_edge(mesh, mesh.tets[row(tet)]);
    if (6 * std::abs(volume) > flat_share * edge * edge * edge) { return {}; }
    return Error{
        fmt::format("{} is degenerate: volume {:.3g} m^3 at edges of {:.3g} m; remesh without slivers",
                    name_tet(mesh, tet), volume, edge)};
}

Fault find_tet_fault(const TetMesh& mesh) {
    for (Index tet = 0; tet < static_cast<Index>(mesh.tets.size()); ++tet) {
        if (Fault fault = find_corner_fault(mesh, tet)) { return fault; }
        if (Fault fault = find_flat_fault(mesh, tet)) { return fault; }
    }
    return {};
}

/// All inverted: turned. Some: refused.
Fault mend_orientation(TetMesh& mesh, std::vector<std::string>& notes) {
    std::size_t inverted = 0;
    Index first = -1;
    for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) {
        if (signed_volume(mesh, mesh.tets[tet]) > 0) { continue; }
        if (inverted++ == 0) { first = static_cast<Index>(tet); }
    }
    if (inverted == 0) { return {}; }
    if (inverted < mesh.tets.size()) {
        return Error{fmt::format(
            "{} of {} tets are inverted, first {} (volume {:.3g} m^3); swap two of their "
            "nodes",
            inverted, mesh.tets.size(), name_tet(mesh, first), signed_volume(mesh, mesh.tets[row(first)]))};
    }
    for (Tet& tet : mesh.tets) {
        std::swap(tet[2], tet[3]);
    }
    notes.push_back(
        fmt::format("all {} tets were inverted: turned (nodes 2 and 3 of each swapped)", inverted));
    return {};
}

Index apex(const TetMesh& mesh, Index slot) { return mesh.tets[row(slot / 4)][row(slot % 4)]; }

/// Whether two tets see the nodes of their face in the same turning sense, which puts both on one side of it.
bool on_same_side(const TetMesh& mesh, Index slot, Index other) {
    const Triangle a = face_nodes(mesh, slot);
    const Triangle b = face_nodes(mesh, other);
    const std::size_t at = row(static_cast<Index>(std::find(b.begin(), b.end(), a[0]) - b.begin()));
    return b[(at + 1) % 3] == a[1];
}

/// `slots`: all slots of one face.
Fault find_face_fault(const TetMesh& mesh, std::span<const Index> slots) {
    for (std::size_t i = 1; i < slots.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            if (apex(mesh, slots[i]) != apex(mesh, slots[k])) { continue; }
            return Error{fmt::format("{} is a duplicate of tet {}; remove one of them",
                                     name_tet(mesh, slots[i] / 4), slots[k] / 4)};
        }
    }
    const auto nodes = fmt::to_string(fmt::join(face_nodes(mesh, slots[0]), " "));
    if (slots.size() > 2) {
        return Error{
            fmt::format("face ({}) is shared by {} tets, among them {}, {} and {}: they overlap; remove "
                        "all but two",
                        nodes, slots.size(), slots[0] / 4, slots[1] / 4, slots[2] / 4)};
    }
    if (slots.size() == 2 && on_same_side(mesh, slots[0], slots[1])) {
        return Error{
            fmt::format("tets {} and {} overlap: both lie on one side of their face ({}); remesh there",
                        slots[0] / 4, slots[1] / 4, nodes)};
    }
    return {};
}

Fault find_shared_fault(const TetMesh& mesh) {
    const FaceGroups groups = build_face_groups(mesh);
    for (std::size_t i = 0; i < groups.size(); ++i) {
        if (Fault fault = find_face_fault(mesh, groups[i])) { return fault; }
    }
    return {};
}

Fault find_loose_fault(const TetMesh& mesh, std::vector<std::string>& notes) {
    const Components components = build_components(build_face_mates(mesh));
    if (components.sizes.size() == 1) { return {}; }
    for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) {
        if (components.sizes[row(components.of_tet[tet])] > 1) { continue; }
        return Error{
            fmt::format("{} is disconnected: it shares no face with another; remove it or join its nodes",
                        name_tet(mesh, static_cast<Index>(tet)))};
    }
    constexpr std::size_t most_named = 8;
    const std::size_t named = std::min(components.sizes.size(), most_named);
    notes.push_back(fmt::format("the mesh has {} separate components, of {}{} tets", components.sizes.size(),
                                fmt::join(std::span(components.sizes).first(named), ", "),
                                named < components.sizes.size() ? ", ..." : ""));
    return {};
}

void note_unused_nodes(const TetMesh& mesh, std::vector<std::string>& notes) {
    std::vector<char> used(mesh.nodes.size(), 0);
    for (const Tet& tet : mesh.tets) {
        for (const Index node : tet) {
            used[row(node)] = 1;
        }
    }
    const auto unused = std::count(used.begin(), used.end(), 0);
    if (unused == 0) { return; }
    notes.push_back(fmt::format("{} nodes belong to no tet, first node {}: kept, without mass", unused,
                                std::find(used.begin(), used.end(), 0) - used.begin()));
}

} // namespace

Result<std::vector<std::string>> mend_and_validate(TetMesh& mesh) {
    std::vector<std::string> notes;
    Fault fault = find_size_fault(mesh);
    if (!fault) { fault = find_node_fault(mesh); }
    if (!fault) { fault = find_tet_fault(mesh); }
    if (!fault) { fault = mend_orientation(mesh, notes); }
    if (!fault) { fault = find_shared_fault(mesh); }
    if (!fault) { fault = find_loose_fault(mesh, notes); }
    if (fault) { return *fault; }
    note_unused_nodes(mesh, notes);
    return notes;
}

} // namespace resect
