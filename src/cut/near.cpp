// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "cut/stages.hpp"

// Which copies may meet the blade. Nothing is sorted or refitted as the tissue moves: an element that is
// farther from the blade than both have moved since it was looked at last cannot have come near, so each is
// looked at again only once that much motion has passed (conservative advancement), and blocks of elements
// are skipped as one.
namespace resect {
namespace {

constexpr std::size_t block_size = 32; // elements of `near_order`

/// The ends of what the blade cuts and sees.
Edge reach_of(const BladeFrame& frame, const BladeBox& box) {
    return {frame.tip + frame.length * frame.along, frame.tip - box.beyond_tip * frame.along};
}

double farthest_motion(const Sweep& sweep) {
    if (sweep.before.data() == sweep.after.data()) { return 0; }
    float farthest = 0; // squared
    for (std::size_t n = 0; n < sweep.after.size(); ++n) {
        const Vec3f d = sweep.after[n] - sweep.before[n];
        farthest = std::max(farthest, dot(d, d));
    }
    return 1.000001 * std::sqrt(static_cast<double>(farthest)); // of floats
}

double motion_of(const Sweep& sweep, const BladeBox& box) {
    const Edge from = reach_of(sweep.from, box);
    const Edge to = reach_of(sweep.to, box);
    return std::max(length(to.heel - from.heel), length(to.tip - from.tip)) + farthest_motion(sweep);
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

/// How far the copies of an element are from the blade at the sweep's end, at least; 0 if they may meet it.
double find_gap(Cutter& cutter, const Sweep& sweep, const BladeBox& box, Index element) {
    const double across = std::sqrt(2.0) * box.across; // the frame may turn about the blade
    const Vec3 lo = {-across, -across, -box.beyond_tip - across};
    const Vec3 hi = {across, across, box.length + across};
    double gap = std::numeric_limits<double>::infinity();
    for (Index c = cutter.first_copy[row(element)]; c >= 0; c = cutter.sibling[row(c)]) {
        const Tet& nodes = cutter.mesh.copy_node[row(c)];
        Vec3 low = place_node(cutter, sweep, nodes[0]);
        Vec3 high = low;
        for (std::size_t k = 1; k < 4; ++k) {
            const Vec3& p = place_node(cutter, sweep, nodes[k]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], p[axis]);
                high[axis] = std::max(high[axis], p[axis]);
            }
        }
        double apart = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            apart = std::max({apart, low[axis] - hi[axis], lo[axis] - high[axis]});
        }
        gap = std::min(gap, apart);
    }
    return gap;
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

void find_near_copies(Cutter& cutter, Blade& blade, const Sweep& sweep, const BladeBox& box) {
    Scratch& scratch = cutter.scratch;
    scratch.near_copies.clear();
    scratch.copies_ahead.clear();
    if (scratch.node_outside.size() < cutter.mesh.node_reference.size()) {
        scratch.node_outside.resize(2 * cutter.mesh.node_reference.size());
        scratch.place.resize(2 * cutter.mesh.node_reference.size());
    }
    scratch.placed.clear(cutter.mesh.node_reference.size());
    scratch.classified.clear(cutter.mesh.node_reference.size());
    Approach& approach = blade.approach;
    const std::size_t count = cutter.near_order.size();
    approach.safe_until.resize(count, -1);
    approach.block_safe_until.resize((count + block_size - 1) / block_size, -1);
    const double motion = motion_of(sweep, box);
    approach.moved += motion;
    for (std::size_t block = 0; block < approach.block_safe_until.size(); ++block) {
        if (approach.moved <= approach.block_safe_until[block]) { continue; }
        double safe_until = std::numeric_limits<double>::infinity();
        for (std::size_t i = block * block_size; i < std::min(count, (block + 1) * block_size); ++i) {
            if (approach.moved > approach.safe_until[i]) {
                const double gap = find_gap(cutter, sweep, box, cutter.near_order[i]);
                const bool is_far = gap > motion + box.ahead; // not, if it is not a number
                approach.safe_until[i] = approach.moved + (is_far ? gap - box.ahead : 0);
                if (!is_far) { list_copies(cutter, sweep, box, cutter.near_order[i]); }
            }
            safe_until = std::min(safe_until, approach.safe_until[i]);
        }
        approach.block_safe_until[block] = safe_until;
    }
}

} // namespace resect
