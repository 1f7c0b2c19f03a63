// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/index.hpp"
#include "fem/pack_rows.hpp"

namespace resect {
namespace {

constexpr std::size_t at_least = 96, at_most = 160; // copies alone that one call seats in fans

bool is_alone(const Packing& packing, Index part_row, Index copy) {
    const Seat& seat = packing.seats[row(copy)];
    const Part& part = packing.parts[row(part_row)];
    return seat.part == part_row && part.blocks[row(block_of(part, seat.tet))].length == 1;
}

/// The earliest that are alone still, each once.
std::vector<Index> take_alone(Packing& packing, Index part_row) {
    std::vector<Index>& alone = packing.parts[row(part_row)].alone;
    const std::size_t count = std::min(alone.size(), at_most);
    std::vector<Index> taken(alone.begin(), alone.begin() + static_cast<std::ptrdiff_t>(count));
    alone.erase(alone.begin(), alone.begin() + static_cast<std::ptrdiff_t>(count));
    std::sort(taken.begin(), taken.end());
    taken.erase(std::unique(taken.begin(), taken.end()), taken.end());
    std::erase_if(taken, [&](Index copy) { return !is_alone(packing, part_row, copy); });
    return taken;
}

std::vector<Index> copies_in(const Part& part, const FanBlock& block) {
    std::vector<Index> copies;
    for (Index tet = block.first_tet; tet < block.first_tet + block.length; ++tet) {
        const auto& at = part.copies[row(tet)].at;
        std::copy_if(std::begin(at), std::end(at), std::back_inserter(copies),
                     [](Index c) { return c >= 0; });
    }
    return copies;
}

/// The rows of the block are for the next one of its kind.
void drop_block(Part& part, Index block) {
    std::erase(part.spare, part.blocks[row(block)].first_tet);
    part.dropped.push_back(part.blocks[row(block)]);
    part.blocks.erase(part.blocks.begin() + block);
}

void drop_empty_blocks(Part& part) {
    for (Index block = static_cast<Index>(part.blocks.size()) - 1; block >= 0; --block) {
        if (copies_in(part, part.blocks[row(block)]).empty()) { drop_block(part, block); }
    }
}

/// The first block of fans of which cuts have left less than three quarters. What becomes alone is too little
/// to bring the next call about by itself.
void dissolve_one(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part_row) {
    Part& part = packing.parts[row(part_row)];
    for (Index block = 0; block < static_cast<Index>(part.blocks.size()); ++block) {
        const Index length = part.blocks[row(block)].length;
        const std::vector<Index> copies = copies_in(part, part.blocks[row(block)]);
        const bool is_full = 4 * copies.size() > 3 * row(length * fan_lanes);
        if (length == 1 || is_full || copies.size() >= at_least) { continue; }
        for (const Index copy : copies) {
            leave_seat(packing, copy);
        }
        drop_block(part, block);
        for (const Index copy : copies) {
            seat_alone(packing, elements, nodes, part_row, copy);
        }
        return;
    }
}

} // namespace

void repack(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part_row) {
    if (packing.parts[row(part_row)].alone.size() < at_least) { return; }
    const std::vector<Index> copies = take_alone(packing, part_row);
    for (const Index copy : copies) {
        leave_seat(packing, copy);
    }
    pack_copies(packing, elements, nodes, part_row, copies);
    dissolve_one(packing, elements, nodes, part_row);
    drop_empty_blocks(packing.parts[row(part_row)]);
}

} // namespace resect
