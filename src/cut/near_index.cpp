// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "cut/stages.hpp"

namespace resect {
namespace {

/// Points in an order that keeps neighbours close together: by the bits of their coordinates, in turn.
std::vector<Index> order_by_place(std::span<const Vec3> points, const Box& box) {
    const Vec3 size = box.hi - box.lo;
    const double largest = std::max({size[0], size[1], size[2]});
    std::vector<std::pair<std::uint32_t, Index>> codes;
    codes.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::uint32_t code = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double share = (points[i][axis] - box.lo[axis]) / largest;
            const auto cell = static_cast<std::uint32_t>(1023 * std::clamp(share, 0.0, 1.0));
            for (unsigned bit = 0; bit < 10; ++bit) {
                code |= ((cell >> bit) & 1U) << (3U * bit + static_cast<unsigned>(axis));
            }
        }
        codes.emplace_back(code, static_cast<Index>(i));
    }
    std::sort(codes.begin(), codes.end());
    std::vector<Index> order;
    order.reserve(codes.size());
    for (const auto& code : codes) {
        order.push_back(code.second);
    }
    return order;
}

void add_node(Cutter& cutter, Index node) {
    NearIndex& near = cutter.near;
    if (near.groups.empty() || near.groups.back().count == nodes_in_group) { near.groups.emplace_back(); }
    NodeGroup& group = near.groups.back();
    const Vec3f rest = to_float(rest_of_node(cutter, node));
    const std::size_t end = group.count == 0 ? nodes_in_group : group.count + 1;
    for (std::size_t k = group.count; k < end; ++k) {
        group.node[k] = node;
        group.x[k] = rest[0];
        group.y[k] = rest[1];
        group.z[k] = rest[2];
    }
    ++group.count;
    near.group_of_node.resize(std::max(near.group_of_node.size(), row(node) + 1));
    near.group_of_node[row(node)] = static_cast<Index>(near.groups.size()) - 1;
}

/// Lists the copies of a block's elements and what they hang on anew.
void fill_block(Cutter& cutter, std::size_t b) {
    NearIndex& near = cutter.near;
    NearBlock& block = near.blocks[b];
    block.copies.clear();
    block.groups.clear();
    near.listed.clear(near.groups.size());
    const std::size_t begin = b * elements_in_block;
    for (std::size_t i = begin; i < std::min(near.order.size(), begin + elements_in_block); ++i) {
        for (Index c = cutter.first_copy[row(near.order[i])]; c >= 0; c = cutter.sibling[row(c)]) {
            const Tet& nodes = cutter.mesh.copy_node[row(c)];
            block.copies.push_back({c, nodes});
            for (const Index node : nodes) {
                const Index group = near.group_of_node[row(node)];
                if (near.listed.set(group)) { block.groups.push_back(group); }
            }
        }
    }
}

void group_nodes(Cutter& cutter) {
    std::vector<Vec3> rest;
    for (Index node = 0; row(node) < cutter.mesh.node_reference.size(); ++node) {
        rest.push_back(rest_of_node(cutter, node));
    }
    for (const Index node : order_by_place(rest, bounds_of(cutter.body.elements))) {
        add_node(cutter, node);
    }
    cutter.near.blocks.resize((cutter.near.order.size() + elements_in_block - 1) / elements_in_block);
    for (std::size_t block = 0; block < cutter.near.blocks.size(); ++block) {
        fill_block(cutter, block);
    }
}

void expire(Cutter& cutter, std::vector<double> Approach::*safe_until, std::size_t at) {
    for (Blade& blade : cutter.blades) {
        std::vector<double>& known = blade.approach.*safe_until;
        if (at < known.size()) { known[at] = -1; }
    }
}

} // namespace

void index_by_place(Cutter& cutter) {
    NearIndex& near = cutter.near;
    const TetMesh& mesh = cutter.body.elements;
    const Box box = bounds_of(mesh);
    std::vector<Vec3> middles;
    middles.reserve(mesh.tets.size());
    for (const Tet& tet : mesh.tets) {
        Vec3 middle = {};
        for (const Index v : tet) {
            middle += 0.25 * mesh.nodes[row(v)];
        }
        middles.push_back(middle);
    }
    near.order = order_by_place(middles, box);
    near.place_of_element.resize(near.order.size());
    for (std::size_t i = 0; i < near.order.size(); ++i) {
        near.place_of_element[row(near.order[i])] = static_cast<Index>(i);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        near.scale += std::max(std::abs(box.lo[axis]), std::abs(box.hi[axis]));
    }
    group_nodes(cutter);
}

void forget_places(Cutter& cutter) {
    cutter.near.groups.clear();
    cutter.near.group_of_node.clear();
    cutter.near.changed.clear();
}

void note_changed_copy(Cutter& cutter, Index copy) { cutter.near.changed.push_back(copy); }

void follow_cuts(Cutter& cutter) {
    NearIndex& near = cutter.near;
    if (near.groups.empty()) { group_nodes(cutter); }
    for (std::size_t node = near.group_of_node.size(); node < cutter.mesh.node_reference.size(); ++node) {
        add_node(cutter, static_cast<Index>(node));
        expire(cutter, &Approach::safe_until, near.groups.size() - 1);
    }
    std::vector<Index>& changed = near.changed; // copies, some taken back; then their blocks
    std::erase_if(changed, [&](Index copy) { return row(copy) >= cutter.mesh.copy_node.size(); });
    for (Index& copy : changed) {
        const Index element = cutter.mesh.copy_element[row(copy)];
        copy = near.place_of_element[row(element)] / static_cast<Index>(elements_in_block);
    }
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    for (const Index block : changed) {
        fill_block(cutter, row(block));
        expire(cutter, &Approach::block_safe_until, row(block));
    }
    changed.clear();
}

} // namespace resect
