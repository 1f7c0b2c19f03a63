// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "cut/stages.hpp"

// Which copies may meet the blade. Nothing is sorted or refitted as the tissue moves: a block of elements
// that is farther from the blade than both have moved since it was looked at last cannot have come near, so
// each is looked at again only once that much motion has passed (conservative advancement).
namespace resect {
namespace {

constexpr std::size_t block_size = 32; // elements of `near_order`

/// The ends of what the blade cuts and sees.
Edge reach_of(const BladeFrame& frame, const BladeBox& box) {
    return {frame.tip + frame.length * frame.along, frame.tip - box.beyond_tip * frame.along};
}

/// Squared distances that the nodes move, by reference node, m^2: the most of each one's copies.
void find_motions(Cutter& cutter, const Sweep& sweep) {
    std::vector<float>& motion = cutter.scratch.motion_squared;
    motion.assign(cutter.body.elements.nodes.size(), 0);
    if (sweep.before.data() == sweep.after.data()) { return; }
    for (std::size_t node = 0; node < sweep.after.size(); ++node) {
        const Vec3f d = sweep.after[node] - sweep.before[node];
        float& most = motion[row(cutter.mesh.node_reference[node])];
        most = std::max(most, dot(d, d));
    }
}

/// How far the nodes of a block of elements move, at most, m.
double find_motion(const Cutter& cutter, std::size_t block) {
    float most = 0; // squared
    for (Index i = cutter.near_nodes.first[block]; i < cutter.near_nodes.first[block + 1]; ++i) {
        most = std::max(most, cutter.scratch.motion_squared[row(cutter.near_nodes.node[row(i)])]);
    }
    return 1.000001 * std::sqrt(double{most}); // of floats
}

/// How far what the blade cuts and sees moves, at most, m.
double blade_motion(const Sweep& sweep, const BladeBox& box) {
    const Edge from = reach_of(sweep.from, box);
    const Edge to = reach_of(sweep.to, box);
    return std::max(length(to.heel - from.heel), length(to.tip - from.tip));
}

/// Where a node is at the sweep's end, in the blade's frame.
const Vec3& place_node(Cutter& cutter, const Sweep& sweep, Index node) {
    Scratch& scratch = cutter.scratch;
    if (scratch.placed.set(node)) {
        const Vec3& rest = cutter.body.elements.nodes[row(cutter.mesh.node_reference[row(node)])];
        scratch.place[row(node)] = to_frame(sweep.to, rest + to_double(sweep.after[row(node)]));
    }
    return scratch.place[row(node)];
}

/// Where a copy is at the sweep's end, in the blade's frame.
Box find_bounds(Cutter& cutter, const Sweep& sweep, Index copy) {
    const Tet& nodes = cutter.mesh.copy_node[row(copy)];
    const Vec3& first = place_node(cutter, sweep, nodes[0]);
    Box box = {first, first};
    for (std::size_t k = 1; k < 4; ++k) {
        const Vec3& place = place_node(cutter, sweep, nodes[k]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = std::min(box.lo[axis], place[axis]);
            box.hi[axis] = std::max(box.hi[axis], place[axis]);
        }
    }
    return box;
}

/// How far a copy is from what the blade cuts and sees, at least; 0 if they may meet, and if it is nowhere.
double find_gap(const Box& copy, const BladeBox& blade) {
    const double across = std::sqrt(2.0) * blade.across; // the frame may turn about the blade
    const Vec3 lo = {-across, -across, -blade.beyond_tip - across};
    const Vec3 hi = {across, across, blade.length + across};
    double apart = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        apart = std::max({apart, copy.lo[axis] - hi[axis], lo[axis] - copy.hi[axis]});
    }
    return apart;
}

/// How far from the blade's tip some of the box may be, at most.
double farthest_of(const Box& box) {
    double reach = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        reach += std::max(-box.lo[axis], box.hi[axis]);
    }
    return reach;
}

std::span<const Index> elements_of(const Cutter& cutter, std::size_t block) {
    const std::size_t begin = block * block_size;
    return std::span(cutter.near_order)
        .subspan(begin, std::min(block_size, cutter.near_order.size() - begin));
}

/// Lists the copies of a block that may meet the blade, and returns how far the nearest is from it.
double list_copies(Cutter& cutter, const Sweep& sweep, const BladeBox& box, std::size_t block, double moved) {
    Scratch& scratch = cutter.scratch;
    const double turn = length(sweep.to.along - sweep.from.along);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Index element : elements_of(cutter, block)) {
        for (Index c = cutter.first_copy[row(element)]; c >= 0; c = cutter.sibling[row(c)]) {
            const Box bounds = find_bounds(cutter, sweep, c);
            const double gap = find_gap(bounds, box);
            nearest = std::min(nearest, gap);
            // What is far from the tip moves the more, the more the blade turns.
            if (gap <= moved + turn * farthest_of(bounds)) { scratch.near_copies.push_back(c); }
            if (box.ahead > 0 && gap <= moved + box.ahead) { scratch.copies_ahead.push_back(c); }
        }
    }
    return nearest;
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

BlockNodes list_block_nodes(const TetMesh& mesh, std::span<const Index> order) {
    BlockNodes nodes;
    nodes.first.push_back(0);
    for (std::size_t begin = 0; begin < order.size(); begin += block_size) {
        std::vector<Index> own;
        for (const Index element : order.subspan(begin, std::min(block_size, order.size() - begin))) {
            own.insert(own.end(), mesh.tets[row(element)].begin(), mesh.tets[row(element)].end());
        }
        std::sort(own.begin(), own.end());
        nodes.node.insert(nodes.node.end(), own.begin(), std::unique(own.begin(), own.end()));
        nodes.first.push_back(static_cast<Index>(nodes.node.size()));
    }
    return nodes;
}

void find_near_copies(Cutter& cutter, Blade& blade, const Sweep& sweep, const BladeBox& box) {
    Scratch& scratch = cutter.scratch;
    const std::size_t nodes = cutter.mesh.node_reference.size();
    const std::size_t blocks = cutter.near_nodes.first.size() - 1;
    scratch.near_copies.clear();
    scratch.copies_ahead.clear();
    if (scratch.place.size() < nodes) { scratch.place.resize(2 * nodes); }
    scratch.placed.clear(nodes);
    blade.margin.resize(blocks, 0);
    find_motions(cutter, sweep);
    const double motion = blade_motion(sweep, box);
    for (std::size_t block = 0; block < blocks; ++block) {
        const double moved = motion + find_motion(cutter, block);
        blade.margin[block] -= moved;
        if (blade.margin[block] > 0) { continue; }
        blade.margin[block] = list_copies(cutter, sweep, box, block, moved) - box.ahead;
    }
}

} // namespace resect
