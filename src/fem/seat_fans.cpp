// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "base/index.hpp"
#include "fem/pack_rows.hpp"

namespace resect {
namespace {

Index node_rows(const FanBlock& block) { return block.length + (block.closed != 0 ? 2 : 3); }

/// The rows of a block that was dropped, of the same kind; or new ones.
FanBlock take_rows(Part& part, const FanBlock& like) {
    FanBlock block = like;
    const auto found = std::find_if(part.dropped.begin(), part.dropped.end(), [&](const FanBlock& dropped) {
        return dropped.length == like.length && dropped.closed == like.closed;
    });
    if (found != part.dropped.end()) {
        block.first_node = found->first_node;
        block.first_tet = found->first_tet;
        part.dropped.erase(found);
        return block;
    }
    block.first_node = static_cast<int>(part.nodes.size());
    block.first_tet = static_cast<int>(part.tets.size());
    part.nodes.resize(part.nodes.size() + row(node_rows(block)));
    part.tets.resize(part.tets.size() + row(block.length));
    part.copies.resize(part.copies.size() + row(block.length));
    return block;
}

/// Adds a block with no fan in it; all lanes stand on one node.
Index add_block(Packing& packing, const NodeArrays& nodes, Index part_row, const FanBlock& like,
                Index any_node) {
    const Index slot = slot_for(packing, nodes, part_row, any_node);
    Part& part = packing.parts[row(part_row)];
    const FanBlock block = take_rows(part, like);
    FanNodes standing = {};
    std::fill(std::begin(standing.at), std::end(standing.at),
              static_cast<unsigned>(slot - part.first_slot) * unsigned{sizeof(Row)});
    FanCopies none = {};
    std::fill(std::begin(none.at), std::end(none.at), -1);
    std::fill_n(part.nodes.begin() + block.first_node, node_rows(block), standing);
    std::fill_n(part.tets.begin() + block.first_tet, block.length, FanTets{});
    std::fill_n(part.copies.begin() + block.first_tet, block.length, none);
    const Index before = block_of(part, block.first_tet); // -1: none
    part.blocks.insert(part.blocks.begin() + (before + 1), block);
    return before + 1;
}

struct Lane {
    Index block = -1, lane = -1; // row of Part::blocks
};

/// Fans shorter than their block stay on their last node.
void write_fan(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part_row,
               const Lane& to, const Fan& fan) {
    const FanBlock block = packing.parts[row(part_row)].blocks[row(to.block)];
    for (Index i = 0; i < node_rows(block); ++i) {
        const Index node = fan.node[row(std::min(i, fan.length + 2))];
        const Index slot = slot_for(packing, nodes, part_row, node);
        Part& part = packing.parts[row(part_row)];
        part.nodes[row(block.first_node + i)].at[to.lane] =
            static_cast<unsigned>(slot - part.first_slot) * unsigned{sizeof(Row)};
    }
    for (Index j = 0; j < fan.length; ++j) {
        const Index copy = fan.tet[row(j)];
        Seat& seat = packing.seats[row(copy)];
        seat.part = part_row;
        seat.tet = block.first_tet + j;
        seat.lane = to.lane;
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
        const Index block = add_block(
            packing, nodes, part,
            {.length = length, .closed = closed ? 1 : 0, .shear_over_resistance = shear_over_resistance},
            of_one_block.front()->node[0]);
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
        lane = {add_block(packing, nodes, part_row, {.length = 1, .shear_over_resistance = ratio}, node[0]),
                0};
        Part& part = packing.parts[row(part_row)];
        part.spare.push_back(part.blocks[row(lane.block)].first_tet);
    }
    ++packing.parts[row(part_row)].cells[row(packing.seats[row(copy)].cell)].moved;
    write_fan(packing, elements, nodes, part_row, lane,
              {.length = 1, .node = {node[0], node[1], node[2], node[3]}, .tet = {copy}});
}

void leave_seat(Packing& packing, Index copy) {
    const Seat& from = packing.seats[row(copy)];
    clear_tet(packing, from);
    Part& part = packing.parts[row(from.part)];
    const bool is_alone = part.blocks[row(block_of(part, from.tet))].length == 1;
    if (is_alone && std::find(part.spare.begin(), part.spare.end(), from.tet) == part.spare.end()) {
        part.spare.push_back(from.tet);
    }
}

void seat_new_copy(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index copy,
                   Index parent) {
    packing.seats.resize(std::max(packing.seats.size(), row(copy) + 1));
    const Seat& beside = packing.seats[row(parent)];
    packing.seats[row(copy)].cell = beside.cell;
    packing.parts[row(beside.part)].cells[row(beside.cell)].copies.push_back(copy);
    seat_alone(packing, elements, nodes, beside.part, copy);
}

void reseat_copy(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index copy) {
    leave_seat(packing, copy);
    seat_alone(packing, elements, nodes, packing.seats[row(copy)].part, copy);
}

void refresh_copy(Packing& packing, const Elements& elements, Index copy) {
    write_tet(packing, elements, copy);
}

} // namespace resect
