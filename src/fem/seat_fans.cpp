// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "base/index.hpp"
#include "fem/pack_rows.hpp"

namespace resect {
namespace {

/// Appends a block of `length` with no fan in it; all lanes stand on one node.
void append_block(Packing& packing, const NodeArrays& nodes, Index part_row, const FanBlock& like,
                  Index any_node) {
    const Index slot = slot_for(packing, nodes, part_row, any_node);
    Part& part = packing.parts[row(part_row)];
    FanBlock block = like;
    block.first_node = static_cast<int>(part.nodes.size());
    block.first_tet = static_cast<int>(part.tets.size());
    FanNodes standing = {};
    std::fill(std::begin(standing.at), std::end(standing.at),
              static_cast<unsigned>(slot - part.first_slot) * unsigned{sizeof(Row)});
    FanCopies none = {};
    std::fill(std::begin(none.at), std::end(none.at), -1);
    part.blocks.push_back(block);
    part.nodes.insert(part.nodes.end(), row(block.length + (block.closed != 0 ? 2 : 3)), standing);
    part.tets.insert(part.tets.end(), row(block.length), FanTets{});
    part.copies.insert(part.copies.end(), row(block.length), none);
}

struct Lane {
    Index block = -1, lane = -1;
};

/// Fans shorter than their block stay on their last node.
void write_fan(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part_row,
               const Lane& to, const Fan& fan) {
    const FanBlock block = packing.parts[row(part_row)].blocks[row(to.block)];
    const Index node_rows = block.length + (block.closed != 0 ? 2 : 3);
    for (Index i = 0; i < node_rows; ++i) {
        const Index node = fan.node[row(std::min(i, fan.length + 2))];
        const Index slot = slot_for(packing, nodes, part_row, node);
        Part& part = packing.parts[row(part_row)];
        part.nodes[row(block.first_node + i)].at[to.lane] =
            static_cast<unsigned>(slot - part.first_slot) * unsigned{sizeof(Row)};
    }
    for (Index j = 0; j < fan.length; ++j) {
        const Index copy = fan.tet[row(j)];
        packing.seats[row(copy)] = {part_row, block.first_tet + j, to.lane};
        packing.parts[row(part_row)].copies[row(block.first_tet + j)].at[to.lane] = copy;
        write_tet(packing, elements, copy);
    }
}

} // namespace

float shear_over_resistance(const Elements& elements, Index copy) {
    const ElementBlock& block = elements.blocks[row(copy / lanes)];
    return block.mu[copy % lanes] / block.bulk[copy % lanes];
}

void append_fans(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part,
                 std::span<const Fan> fans, float shear_over_resistance) {
    const auto append = [&](std::span<const Fan* const> of_one_block, Index length, bool closed) {
        append_block(
            packing, nodes, part,
            {.length = length, .closed = closed ? 1 : 0, .shear_over_resistance = shear_over_resistance},
            of_one_block.front()->node[0]);
        const Index block = static_cast<Index>(packing.parts[row(part)].blocks.size()) - 1;
        for (std::size_t lane = 0; lane < of_one_block.size(); ++lane) {
            write_fan(packing, elements, nodes, part, {block, static_cast<Index>(lane)}, *of_one_block[lane]);
        }
    };
    std::map<std::pair<Index, bool>, std::vector<const Fan*>> waiting; // longest first
    for (const Fan& fan : fans) {
        std::vector<const Fan*>& alike = waiting[{-fan.length, fan.closed}];
        alike.push_back(&fan);
        if (alike.size() == row(fan_lanes)) {
            append(alike, fan.length, fan.closed);
            alike.clear();
        }
    }
    std::vector<const Fan*> left; // open blocks of mixed lengths take them all
    for (const auto& [kind, alike] : waiting) {
        left.insert(left.end(), alike.begin(), alike.end());
    }
    for (std::size_t at = 0; at < left.size(); at += row(fan_lanes)) {
        const std::span block = std::span(left).subspan(at, std::min(left.size() - at, row(fan_lanes)));
        append(block, block.front()->length, false);
    }
}

namespace {

Lane find_spare_lane(Part& part, float ratio) {
    for (std::size_t i = part.spare.size(); i-- > 0;) {
        const FanBlock& block = part.blocks[row(block_of(part, part.spare[i]))];
        const auto& copies = part.copies[row(part.spare[i])].at;
        const auto free = std::find(std::begin(copies), std::end(copies), -1);
        if (free == std::end(copies)) {
            part.spare.erase(part.spare.begin() + static_cast<std::ptrdiff_t>(i));
        } else if (block.shear_over_resistance == ratio) {
            return {block_of(part, part.spare[i]), static_cast<Index>(free - std::begin(copies))};
        }
    }
    return {};
}

} // namespace

void seat_alone(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part_row,
                Index copy) {
    const float ratio = shear_over_resistance(elements, copy);
    const Tet node = corners(elements, copy);
    Lane lane = find_spare_lane(packing.parts[row(part_row)], ratio);
    if (lane.block < 0) {
        append_block(packing, nodes, part_row, {.length = 1, .shear_over_resistance = ratio}, node[0]);
        Part& part = packing.parts[row(part_row)];
        lane = {static_cast<Index>(part.blocks.size()) - 1, 0};
        part.spare.push_back(part.blocks.back().first_tet);
    }
    packing.parts[row(part_row)].alone.push_back(copy);
    write_fan(packing, elements, nodes, part_row, lane,
              {.length = 1, .node = {node[0], node[1], node[2], node[3]}, .tet = {copy}});
}

void leave_seat(Packing& packing, Index copy) {
    const Seat& from = packing.seats[row(copy)];
    clear_tet(packing, from);
    Part& part = packing.parts[row(from.part)];
    const bool is_alone = part.blocks[row(block_of(part, from.tet))].length == 1;
    const bool is_spare = std::find(part.spare.begin(), part.spare.end(), from.tet) != part.spare.end();
    if (is_alone && !is_spare) { part.spare.push_back(from.tet); }
}

void seat_new_copy(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index copy,
                   Index parent) {
    packing.seats.resize(std::max(packing.seats.size(), row(copy) + 1));
    seat_alone(packing, elements, nodes, packing.seats[row(parent)].part, copy);
}

void reseat_copy(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index copy) {
    leave_seat(packing, copy);
    seat_alone(packing, elements, nodes, packing.seats[row(copy)].part, copy);
}

void refresh_copy(Packing& packing, const Elements& elements, Index copy) {
    write_tet(packing, elements, copy);
}

} // namespace resect
