// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cut/stages.hpp"

// Which copies may meet the blade. Nothing is sorted or refitted as the tissue moves: an element that is
// farther from the blade than both have moved since it was looked at last cannot have come near, so each is
// looked at again only once that much motion has passed (conservative advancement). Elements that lie
// together make blocks, which are skipped as one; one that was never near is looked at by boxes around its
// nodes only, in groups of neighbouring numbers (fem, order_nodes).
namespace resect {
namespace {

constexpr Index block_size = 32; // elements of `near_order`
constexpr Index group_size = 32; // nodes

/// How far nodes move at most, axis by axis: four numbers of each axis side by side.
double tissue_motion(const Sweep& sweep) {
    if (sweep.before.data() == sweep.after.data()) { return 0; }
    const float* from = sweep.before.data()->data();
    const float* to = sweep.after.data()->data();
    float farthest[12] = {};
    const std::size_t count = 3 * sweep.after.size(), whole = count - count % 12;
    for (std::size_t i = 0; i < whole; i += 12) {
        for (std::size_t k = 0; k < 12; ++k) {
            const float d = std::abs(to[i + k] - from[i + k]);
            farthest[k] = d > farthest[k] ? d : farthest[k];
        }
    }
    for (std::size_t i = whole; i < count; ++i) {
        farthest[i - whole] = std::max(farthest[i - whole], std::abs(to[i] - from[i]));
    }
    Vec3 most = {};
    for (std::size_t k = 0; k < 12; ++k) {
        most[k % 3] = std::max(most[k % 3], double(farthest[k]));
    }
    return 1.000001 * length(most); // of floats
}

/// The ends of what the blade cuts and sees.
Edge reach_of(const BladeFrame& frame, const BladeBox& box) {
    return {frame.tip + frame.length * frame.along, frame.tip - box.beyond_tip * frame.along};
}

double blade_motion(const Sweep& sweep, const BladeBox& box) {
    const Edge from = reach_of(sweep.from, box);
    const Edge to = reach_of(sweep.to, box);
    return std::max(length(to.heel - from.heel), length(to.tip - from.tip));
}

/// Where a node is at the sweep's end, in the blade's frame.
[[gnu::always_inline]] inline const Vec3& place_node(Cutter& cutter, const Sweep& sweep, Index node) {
    Scratch& scratch = cutter.scratch;
    if (scratch.placed.set(node)) {
        const Vec3& rest = cutter.body.elements.nodes[row(cutter.mesh.node_reference[row(node)])];
        scratch.place[row(node)] = to_frame(sweep.to, rest + to_double(sweep.after[row(node)]));
    }
    return scratch.place[row(node)];
}

/// How far it is from the blade, along the axis where it is farthest; 0 if it may meet it.
double gap_to(const BladeBox& box, const Extent& extent) {
    const double across = std::sqrt(2.0) * box.across; // the frame may turn about the blade
    const Vec3 lo = {-across, -across, -box.beyond_tip - across};
    const Vec3 hi = {across, across, box.length + across};
    double gap = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        gap = std::max(gap, std::max(extent.low[axis] - hi[axis], lo[axis] - extent.high[axis]));
    }
    return gap;
}

/// How far the copies of an element are from the blade at the sweep's end, at least.
double find_gap(Cutter& cutter, const Sweep& sweep, const BladeBox& box, Index element) {
    double gap = std::numeric_limits<double>::infinity();
    for (Index c = cutter.first_copy[row(element)]; c >= 0; c = cutter.sibling[row(c)]) {
        const Tet& nodes = cutter.mesh.copy_node[row(c)];
        const Vec3& first = place_node(cutter, sweep, nodes[0]);
        Extent extent = {first, first};
        for (std::size_t k = 1; k < 4; ++k) {
            extent.add(place_node(cutter, sweep, nodes[k]));
        }
        gap = std::min(gap, gap_to(box, extent));
    }
    return gap;
}

/// Where the nodes of a group are at the sweep's end.
const Extent& find_extent(Cutter& cutter, const Sweep& sweep, Index group) {
    Scratch& scratch = cutter.scratch;
    Extent& extent = scratch.group_extent[row(group)];
    if (scratch.boxed.set(group)) {
        const Index begin = group * group_size;
        const Index end = std::min(begin + group_size, static_cast<Index>(sweep.after.size()));
        const Vec3& first = place_node(cutter, sweep, begin);
        extent = {first, first};
        for (Index node = begin + 1; node < end; ++node) {
            extent.add(place_node(cutter, sweep, node));
        }
    }
    return extent;
}

/// How far all that hangs on a block's nodes is from the blade, at least.
double find_block_gap(Cutter& cutter, const Sweep& sweep, const BladeBox& box, const BlockGroups& groups) {
    if (groups.is_mixed || groups.count == 0) { return 0; }
    Extent extent = find_extent(cutter, sweep, groups.group[0]);
    for (std::size_t i = 1; i < groups.count; ++i) {
        const Extent& other = find_extent(cutter, sweep, groups.group[i]);
        extent.add(other.low);
        extent.add(other.high);
    }
    return gap_to(box, extent);
}

unsigned classify_node(Cutter& cutter, const Sweep& sweep, const BladeBox& box, Index node) {
    Scratch& scratch = cutter.scratch;
    if (scratch.classified.set(node)) {
        const Vec3& rest = cutter.body.elements.nodes[row(cutter.mesh.node_reference[row(node)])];
        const Vec3 before = to_frame(sweep.from, rest + to_double(sweep.before[row(node)]));
        scratch.node_outside[row(node)] =
            sides_beyond(box, before) & sides_beyond(box, place_node(cutter, sweep, node));
    }
    return scratch.node_outside[row(node)];
}

/// Lists the copies of an element but those whose corners all stay beyond one side of the box: nothing
/// between them can meet the blade.
void list_copies(Cutter& cutter, const Sweep& sweep, const BladeBox& box, Index element) {
    for (Index c = cutter.first_copy[row(element)]; c >= 0; c = cutter.sibling[row(c)]) {
        unsigned common = 63;
        for (const Index node : cutter.mesh.copy_node[row(c)]) {
            common &= classify_node(cutter, sweep, box, node);
        }
        if (common == 0) { cutter.scratch.near_copies.push_back(c); }
        if (box.ahead > 0) { cutter.scratch.copies_ahead.push_back(c); }
    }
}

/// Looks at the elements of a block that are due, and lists those that are not far. The value of `moved` up
/// to which all are safe.
double look_at_elements(Cutter& cutter, Approach& approach, const Sweep& sweep, const BladeBox& box,
                        std::size_t block, double motion) {
    double safe_until = std::numeric_limits<double>::infinity();
    const std::size_t begin = block * row(block_size);
    for (std::size_t i = begin; i < std::min(cutter.near_order.size(), begin + row(block_size)); ++i) {
        if (approach.moved > approach.safe_until[i]) {
            const double gap = find_gap(cutter, sweep, box, cutter.near_order[i]);
            const bool is_far = gap > motion + box.ahead; // not, if it is not a number
            approach.safe_until[i] = approach.moved + (is_far ? gap - box.ahead : 0);
            if (!is_far) { list_copies(cutter, sweep, box, cutter.near_order[i]); }
        }
        safe_until = std::min(safe_until, approach.safe_until[i]);
    }
    return safe_until;
}

void look_at_block(Cutter& cutter, Approach& approach, const Sweep& sweep, const BladeBox& box,
                   std::size_t block, double motion) {
    if (approach.is_open[block] == 0) {
        const double gap = find_block_gap(cutter, sweep, box, cutter.block_groups[block]);
        if (gap > motion + box.ahead) {
            approach.block_safe_until[block] = approach.moved + gap - box.ahead;
            return;
        }
        approach.is_open[block] = 1;
    }
    approach.block_safe_until[block] = look_at_elements(cutter, approach, sweep, box, block, motion);
}

BlockGroups& groups_of(Cutter& cutter, Index copy) {
    const Index place = cutter.place_of_element[row(cutter.mesh.copy_element[row(copy)])];
    return cutter.block_groups[row(place / block_size)];
}

void add_group(BlockGroups& groups, Index group) {
    const auto begin = groups.group.begin(), end = begin + static_cast<std::ptrdiff_t>(groups.count);
    if (std::find(begin, end, group) != end) { return; }
    if (groups.count == groups.group.size()) {
        groups.is_mixed = true;
    } else {
        groups.group[groups.count++] = group;
    }
}

} // namespace

void find_block_groups(Cutter& cutter) {
    cutter.block_groups.assign(cutter.near_order.size() / row(block_size) + 1, {});
    for (std::size_t copy = 0; copy < cutter.mesh.copy_node.size(); ++copy) {
        for (const Index node : cutter.mesh.copy_node[copy]) {
            add_group(groups_of(cutter, static_cast<Index>(copy)), node / group_size);
        }
    }
}

namespace {

/// Room for this sweep.
void prepare(Cutter& cutter, Approach& approach) {
    Scratch& scratch = cutter.scratch;
    const std::size_t nodes = cutter.mesh.node_reference.size();
    scratch.near_copies.clear();
    scratch.copies_ahead.clear();
    if (scratch.node_outside.size() < nodes) {
        scratch.node_outside.resize(2 * nodes);
        scratch.place.resize(2 * nodes);
    }
    scratch.group_extent.resize(scratch.place.size() / row(group_size) + 1);
    scratch.placed.clear(nodes);
    scratch.classified.clear(nodes);
    scratch.boxed.clear(scratch.group_extent.size());
    if (cutter.block_groups.empty()) { find_block_groups(cutter); }
    approach.block_safe_until.resize(cutter.block_groups.size(), -1);
    approach.is_open.resize(cutter.block_groups.size(), 0);
    approach.safe_until.resize(cutter.near_order.size(), -1);
}

} // namespace

std::vector<Index> order_by_place(const TetMesh& mesh) {
    const Box box = bounds_of(mesh);
    const Vec3 size = box.hi - box.lo;
    const double largest = std::max({size[0], size[1], size[2]});
    std::vector<std::pair<std::uint32_t, Index>> codes; // the bits of the coordinates of the middle, in turn
    codes.reserve(mesh.tets.size());
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        Vec3 middle = {};
        for (const Index v : mesh.tets[t]) {
            middle += 0.25 * (mesh.nodes[row(v)] - box.lo);
        }
        std::uint32_t code = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto cell = static_cast<std::uint32_t>(1023 * std::clamp(middle[axis] / largest, 0.0, 1.0));
            for (unsigned bit = 0; bit < 10; ++bit) {
                code |= ((cell >> bit) & 1U) << (3U * bit + static_cast<unsigned>(axis));
            }
        }
        codes.emplace_back(code, static_cast<Index>(t));
    }
    std::sort(codes.begin(), codes.end());
    std::vector<Index> order;
    order.reserve(codes.size());
    for (const auto& code : codes) {
        order.push_back(code.second);
    }
    return order;
}

void note_new_node(Cutter& cutter, Index copy) {
    if (!cutter.block_groups.empty()) { groups_of(cutter, copy).is_mixed = true; }
}

void find_near_copies(Cutter& cutter, Blade& blade, const Sweep& sweep, const BladeBox& box) {
    Approach& approach = blade.approach;
    prepare(cutter, approach);
    const double motion = blade_motion(sweep, box) + tissue_motion(sweep);
    approach.moved += motion;
    for (std::size_t block = 0; block < approach.block_safe_until.size(); ++block) {
        if (approach.moved > approach.block_safe_until[block]) {
            look_at_block(cutter, approach, sweep, box, block, motion);
        }
    }
}

} // namespace resect
