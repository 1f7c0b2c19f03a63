// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cut/stages.hpp"

// Which copies may meet the blade. Nothing is sorted or refitted as the tissue moves: nodes that lie farther
// beyond a side of the blade's box than both have moved since they were looked at last lie beyond it still,
// so they are looked at again, in groups, only once that much motion has passed (conservative advancement).
// A copy whose nodes all lie beyond one side is far; elements that lie together make blocks, which are far as
// one where all the groups that they hang on are.
namespace resect {
namespace {

/// Errors of places in single precision, as a share of what they are computed from.
constexpr float rounding = 1e-6F;
/// What a group may use up before it is looked at again: a share of its margin, or this many grains where
/// that is more. Nodes that lie beyond a side by less count as near, so it is not to be much.
constexpr double share_spared = 0.25, grains_spared = 0.05;
/// Of the body's size, that Approach::moved tells small motion by.
constexpr double most_moved = 1e6;

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

/// How far the sides of the blade's box move at most past a point within `reach` of its tip.
double blade_motion(const Sweep& sweep, double reach) {
    const BladeFrame &from = sweep.from, &to = sweep.to;
    const double turn = std::max({length(to.across1 - from.across1), length(to.across2 - from.across2),
                                  length(to.along - from.along)});
    return length(to.tip - from.tip) + std::abs(to.length - from.length) + turn * reach;
}

/// Where the nodes of a group are in the blade's frame, m.
struct Places {
    std::array<float, nodes_in_group> x, y, z;
};

Places place_nodes(const NodeGroup& group, const BladeFrame& frame, std::span<const Vec3f> displacement) {
    Places at = {};
    for (std::size_t k = 0; k < nodes_in_group; ++k) {
        const Vec3f& u = displacement[row(group.node[k])];
        at.x[k] = u[0];
        at.y[k] = u[1];
        at.z[k] = u[2];
    }
    const Vec3f tip = to_float(frame.tip);
    const Vec3f a = to_float(frame.across1), b = to_float(frame.across2), c = to_float(frame.along);
    for (std::size_t k = 0; k < nodes_in_group; ++k) {
        const float x = group.x[k] + at.x[k] - tip[0];
        const float y = group.y[k] + at.y[k] - tip[1];
        const float z = group.z[k] + at.z[k] - tip[2];
        at.x[k] = a[0] * x + a[1] * y + a[2] * z;
        at.y[k] = b[0] * x + b[1] * y + b[2] * z;
        at.z[k] = c[0] * x + c[1] * y + c[2] * z;
    }
    return at;
}

/// The blade's box, in single precision.
struct NearBox {
    float across = 0, low = 0, high = 0; // m
    float scale = 0;                     // m, that rounding errors go by beside the places themselves
};

NearBox make_near_box(const BladeBox& box, double scale) {
    return {static_cast<float>(box.across), static_cast<float>(-box.beyond_tip - box.across),
            static_cast<float>(box.length + box.across), static_cast<float>(scale)};
}

NearBox grown(const NearBox& box, double by) {
    const auto more = static_cast<float>(by);
    return {box.across + more, box.low - more, box.high + more, box.scale};
}

/// [node of the group] A bit for each side of the box that it lies beyond.
using Sides = std::array<std::uint32_t, nodes_in_group>;

Sides find_sides(const Places& at, const NearBox& box) {
    Sides sides;
    for (std::size_t k = 0; k < nodes_in_group; ++k) {
        const float x = at.x[k], y = at.y[k], z = at.z[k];
        const float doubt = rounding * (box.scale + std::abs(x) + std::abs(y) + std::abs(z));
        const float across = box.across + doubt;
        const std::uint32_t beyond_x = (x > across ? 1U : 0U) | (x < -across ? 2U : 0U);
        const std::uint32_t beyond_y = (y > across ? 4U : 0U) | (y < -across ? 8U : 0U);
        const std::uint32_t beyond_z = (z < box.low - doubt ? 16U : 0U) | (z > box.high + doubt ? 32U : 0U);
        sides[k] = beyond_x | beyond_y | beyond_z;
    }
    return sides;
}

std::uint32_t common_of(const Sides& sides) {
    std::uint32_t common = 63;
    for (const std::uint32_t own : sides) {
        common &= own;
    }
    return common;
}

struct Range {
    float low = 0, high = 0;
};

Range range_of(const std::array<float, nodes_in_group>& at) {
    float low[4] = {at[0], at[1], at[2], at[3]};
    float high[4] = {at[0], at[1], at[2], at[3]};
    for (std::size_t i = 4; i < nodes_in_group; i += 4) {
        for (std::size_t k = 0; k < 4; ++k) {
            low[k] = at[i + k] < low[k] ? at[i + k] : low[k];
            high[k] = at[i + k] > high[k] ? at[i + k] : high[k];
        }
    }
    return {*std::min_element(low, low + 4), *std::max_element(high, high + 4)};
}

/// How far beyond one side of the box all nodes of a group lie, and how far from the tip they do at most, m.
struct Margin {
    double beyond = 0, distance = 0;
};

Margin find_margin(const Places& at, const NearBox& box) {
    const Range x = range_of(at.x), y = range_of(at.y), z = range_of(at.z);
    const auto farthest = [](const Range& range) {
        return std::max(std::abs(range.low), std::abs(range.high));
    };
    const double distance = double(farthest(x)) + double(farthest(y)) + double(farthest(z));
    const float beyond = std::max({x.low - box.across, -box.across - x.high, y.low - box.across,
                                   -box.across - y.high, box.low - z.high, z.low - box.high});
    return {double(beyond), distance};
}

/// A sweep, for what looks at S with it.
struct Search {
    const Sweep& sweep;
    const BladeBox& box;
    NearBox near, ahead; // the same, and grown by what lies ahead
    double reach = 0;    // m, from the tip to what is not far away
    double motion = 0;   // m, towards each other
    double spared = 0;   // m, at least
};

/// Sides that the nodes of a group will lie beyond for a while, if that is long enough; else in this sweep.
void look_at_group(const NearIndex& near, Approach& approach, const Search& search, std::size_t g) {
    const NodeGroup& group = near.groups[g];
    const Places after = place_nodes(group, search.sweep.to, search.sweep.after);
    const Margin margin = find_margin(after, search.ahead);
    const double spared = std::max(share_spared * margin.beyond, search.spared);
    // The frame's turn moves more what is far away, or will be.
    const double stretch = std::max(1.0, (margin.distance + spared) / search.reach);
    Sides sides;
    std::uint32_t common = 0;
    if (spared > stretch * search.motion) {
        sides = find_sides(after, grown(search.ahead, spared));
        common = common_of(sides);
        approach.safe_until[g] = approach.moved + spared / stretch;
    } else {
        sides = find_sides(after, search.near);
        const Places before = place_nodes(group, search.sweep.from, search.sweep.before);
        const Sides sides_before = find_sides(before, search.near);
        for (std::size_t k = 0; k < nodes_in_group; ++k) {
            sides[k] &= sides_before[k];
        }
        common = search.box.ahead > 0 ? common_of(find_sides(after, search.ahead)) : common_of(sides);
        approach.safe_until[g] = approach.moved;
    }
    approach.beyond[g] = static_cast<std::uint8_t>(common);
    for (std::size_t k = 0; k < nodes_in_group; ++k) {
        approach.node_beyond[row(group.node[k])] = static_cast<std::uint8_t>(sides[k]);
    }
}

/// Lists the copies of a block but those whose nodes all stay beyond one side of the box: nothing between
/// them can meet the blade.
void list_copies(const Approach& approach, const NearBlock& block, std::vector<Index>& listed) {
    for (const NearBlock::Copy& at : block.copies) {
        unsigned common = 63;
        for (const Index node : at.node) {
            common &= approach.node_beyond[row(node)];
        }
        if (common == 0) { listed.push_back(at.copy); }
    }
}

/// Sides of the box that a node stays beyond, to the last bit.
unsigned classify_node(Cutter& cutter, const Sweep& sweep, const BladeBox& box, Index node) {
    Scratch& scratch = cutter.scratch;
    if (scratch.classified.set(node)) {
        const Vec3& rest = rest_of_node(cutter, node);
        const Vec3 before = to_frame(sweep.from, rest + to_double(sweep.before[row(node)]));
        const Vec3 after = to_frame(sweep.to, rest + to_double(sweep.after[row(node)]));
        scratch.node_outside[row(node)] = sides_beyond(box, before) & sides_beyond(box, after);
    }
    return scratch.node_outside[row(node)];
}

/// Drops those among the listed copies that are far all the same: what is left depends on this sweep only,
/// not on when its nodes were looked at.
void drop_far_copies(Cutter& cutter, const Sweep& sweep, const BladeBox& box) {
    std::erase_if(cutter.scratch.near_copies, [&](Index copy) {
        unsigned common = 63;
        for (const Index node : cutter.mesh.copy_node[row(copy)]) {
            common &= classify_node(cutter, sweep, box, node);
        }
        return common != 0;
    });
}

/// Lists what is near in a block; it is safe where that is nothing.
void look_at_block(Cutter& cutter, Approach& approach, const BladeBox& box, std::size_t b) {
    const NearBlock& block = cutter.near.blocks[b];
    unsigned common = 63;
    double safe_until = std::numeric_limits<double>::infinity();
    for (const Index group : block.groups) {
        common &= approach.beyond[row(group)];
        safe_until = std::min(safe_until, approach.safe_until[row(group)]);
    }
    approach.block_safe_until[b] = safe_until;
    if (common != 0) { return; }
    std::vector<Index>& listed = cutter.scratch.near_copies;
    const std::size_t before = listed.size();
    list_copies(approach, block, listed);
    if (box.ahead > 0) {
        for (const NearBlock::Copy& at : block.copies) {
            cutter.scratch.copies_ahead.push_back(at.copy);
        }
    }
    if (listed.size() > before || box.ahead > 0) { approach.block_safe_until[b] = -1; }
}

void prepare(Cutter& cutter, Approach& approach) {
    follow_cuts(cutter);
    Scratch& scratch = cutter.scratch;
    scratch.near_copies.clear();
    scratch.copies_ahead.clear();
    scratch.classified.clear(cutter.mesh.node_reference.size());
    if (scratch.node_outside.size() < cutter.mesh.node_reference.size()) {
        scratch.node_outside.resize(2 * cutter.mesh.node_reference.size());
    }
    approach.safe_until.resize(cutter.near.groups.size(), -1);
    approach.beyond.resize(cutter.near.groups.size(), 0);
    approach.node_beyond.resize(cutter.near.group_of_node.size(), 0);
    approach.block_safe_until.resize(cutter.near.blocks.size(), -1);
}

Search make_search(const Cutter& cutter, const Sweep& sweep, const BladeBox& box) {
    const auto sum = [](const Vec3& p) { return std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]); };
    const double scale = cutter.near.scale + std::max(sum(sweep.from.tip), sum(sweep.to.tip));
    const double reach = cutter.unit;
    const NearBox near = make_near_box(box, scale);
    return {sweep,
            box,
            near,
            grown(near, box.ahead),
            reach,
            blade_motion(sweep, reach) + tissue_motion(sweep),
            grains_spared * cutter.grain};
}

} // namespace

void find_near_copies(Cutter& cutter, Blade& blade, const Sweep& sweep, const BladeBox& box) {
    Approach& approach = blade.approach;
    prepare(cutter, approach);
    const Search search = make_search(cutter, sweep, box);
    approach.moved += search.motion;
    for (std::size_t group = 0; group < approach.safe_until.size(); ++group) {
        if (!(approach.moved <= approach.safe_until[group])) {
            look_at_group(cutter.near, approach, search, group);
        }
    }
    for (std::size_t block = 0; block < approach.block_safe_until.size(); ++block) {
        if (!(approach.moved <= approach.block_safe_until[block])) {
            look_at_block(cutter, approach, box, block);
        }
    }
    drop_far_copies(cutter, sweep, box);
    if (!(approach.moved < most_moved * search.reach)) { approach = {}; } // small motion would be lost in it
}

} // namespace resect
