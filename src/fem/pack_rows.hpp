// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "fem/fans.hpp"
#include "fem/packing.hpp"

// What building and patching a packing share.
namespace resect {

Index find_slot(const Packing& packing, Index part, Index node); // -1: the node has none in this part
/// The slot of a node in a part, made if need be.
Index slot_for(Packing& packing, const NodeArrays& nodes, Index part, Index node);

Index block_of(const Part& part, Index tet); // row of Part::blocks, of a row of Part::tets
/// mu / K of a copy, which the copies of a block share.
float shear_over_resistance(const Elements& elements, Index copy);

/// Room for the slots of a part that has none yet.
void reserve_slots(Packing& packing, Index part, Index nodes);

/// Covers the copies of a cell with fans and adds their blocks; they sit nowhere.
void pack_cell(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part, Index cell);
/// Sorts copies so that the first `count` lie on one side.
void sort_apart(const Elements& elements, const NodeArrays& nodes, std::span<Index> copies,
                std::size_t count);
/// Fans of one material, whose tets are copies.
void append_fans(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part,
                 std::span<const Fan> fans, float shear_over_resistance);

/// Seats a copy in a block of single tets of a part.
void seat_alone(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part, Index copy);
/// The copy's lane is free for another.
void leave_seat(Packing& packing, Index copy);

/// Writes what the law needs of a copy at its seat.
void write_tet(Packing& packing, const Elements& elements, Index copy);
/// Nobody sits there any more.
void clear_tet(Packing& packing, const Seat& seat);

} // namespace resect
