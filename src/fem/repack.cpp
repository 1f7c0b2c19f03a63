// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/index.hpp"
#include "fem/pack_rows.hpp"

namespace resect {
namespace {

constexpr Index worn = 32, very_worn = 8; // a cell is: one in so many of its copies has been moved
constexpr Index quiet_turns = 40;         // that a cell waits for cuts to be done with it
constexpr std::size_t most_packed = 1920; // copies at a time

void count_turn(Cell& cell) {
    cell.quiet = cell.moved == cell.moved_before ? std::min(cell.quiet + 1, quiet_turns) : 0;
    cell.moved_before = cell.moved;
}

bool is_due(const Cell& cell) {
    const Index least = cell.quiet == quiet_turns ? worn : very_worn;
    return std::int64_t{least} * cell.moved > std::ssize(cell.copies);
}

bool is_less_worn(const Cell& a, const Cell& b) {
    return std::int64_t{a.moved} * std::ssize(b.copies) < std::int64_t{b.moved} * std::ssize(a.copies);
}

/// The row of the due cell with the largest share of copies moved, or -1.
Index find_worn_cell(const std::vector<Cell>& cells) {
    Index most = -1;
    for (Index at = 0; at < static_cast<Index>(cells.size()); ++at) {
        if (!is_due(cells[row(at)])) { continue; }
        if (most < 0 || is_less_worn(cells[row(most)], cells[row(at)])) { most = at; }
    }
    return most;
}

/// One half of a cell that has grown becomes a cell of its own, which comes next.
void split_cell(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part_row,
                Index cell) {
    Part& part = packing.parts[row(part_row)];
    std::vector<Index> low = part.cells[row(cell)].copies;
    const auto half = low.begin() + std::ssize(low) / 2;
    sort_apart(elements, nodes, low, low.size() / 2);
    Cell high;
    high.copies.assign(half, low.end());
    high.moved = static_cast<Index>(high.copies.size());
    low.erase(half, low.end());
    for (const Index copy : high.copies) {
        packing.seats[row(copy)].cell = static_cast<Index>(part.cells.size());
    }
    part.cells[row(cell)].copies = std::move(low);
    part.cells.push_back(std::move(high));
}

bool is_empty(const Part& part, const FanBlock& block) {
    return std::all_of(part.copies.begin() + block.first_tet,
                       part.copies.begin() + block.first_tet + block.length, [](const FanCopies& copies) {
                           return std::all_of(std::begin(copies.at), std::end(copies.at),
                                              [](Index copy) { return copy < 0; });
                       });
}

/// Their rows are for the next blocks of their kind.
void drop_empty_blocks(Part& part) {
    std::erase_if(part.blocks, [&](const FanBlock& block) {
        if (!is_empty(part, block)) { return false; }
        std::erase(part.spare, block.first_tet);
        part.dropped.push_back(block);
        return true;
    });
}

} // namespace

void repack(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part_row) {
    std::vector<Cell>& cells = packing.parts[row(part_row)].cells;
    std::for_each(cells.begin(), cells.end(), count_turn);
    const Index cell = find_worn_cell(cells);
    if (cell < 0) { return; }
    if (packing.parts[row(part_row)].cells[row(cell)].copies.size() > most_packed) {
        split_cell(packing, elements, nodes, part_row, cell);
    }
    for (const Index copy : packing.parts[row(part_row)].cells[row(cell)].copies) {
        leave_seat(packing, copy);
    }
    drop_empty_blocks(packing.parts[row(part_row)]);
    pack_cell(packing, elements, nodes, part_row, cell);
}

} // namespace resect
