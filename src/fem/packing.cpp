// SPDX-License-Identifier: Apache-2.0
#include "fem/packing.hpp"

#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "fem/pack_rows.hpp"

namespace resect {
namespace {

/// Modulo 2^32.
int add(int a, int b) { return static_cast<int>(static_cast<unsigned>(a) + static_cast<unsigned>(b)); }
int subtract(int a, int b) { return static_cast<int>(static_cast<unsigned>(a) - static_cast<unsigned>(b)); }

constexpr Index spare_share = 2;  // of a part's slots there is one more in store
constexpr Index spare_slots = 64; // and these

/// In quanta.
Vec3 rest_edge(const Packing& packing, Index from, Index to) {
    const Place& a = packing.rest[row(from)];
    const Place& b = packing.rest[row(to)];
    return {double(subtract(b.x, a.x)), double(subtract(b.y, a.y)), double(subtract(b.z, a.z))};
}

} // namespace

Index find_slot(const Packing& packing, Index part, Index node) {
    Index slot = packing.first_slot[row(node)];
    while (slot >= 0 && packing.slot_part[row(slot)] != part) {
        slot = packing.next_slot[row(slot)];
    }
    return slot;
}

namespace {

/// Enters a slot among those of its node, parts ascending.
void link_slot(Packing& packing, Index slot) {
    Index* at = &packing.first_slot[row(packing.slot_node[row(slot)])];
    while (*at >= 0 && packing.slot_part[row(*at)] < packing.slot_part[row(slot)]) {
        at = &packing.next_slot[row(*at)];
    }
    packing.next_slot[row(slot)] = *at;
    *at = slot;
}

void unlink_slot(Packing& packing, Index slot) {
    Index* at = &packing.first_slot[row(packing.slot_node[row(slot)])];
    while (*at != slot) {
        at = &packing.next_slot[row(*at)];
    }
    *at = packing.next_slot[row(slot)];
}

/// Moves a part's slots to the end, where it has room for `nodes`.
void make_room(Packing& packing, Index part_row, Index nodes) {
    Part& part = packing.parts[row(part_row)];
    const Index from = part.first_slot;
    part.first_slot = static_cast<Index>(packing.position.size());
    part.room = nodes;
    const std::size_t count = packing.position.size() + row(part.room);
    packing.rest.resize(count);
    packing.position.resize(count);
    packing.force.resize(count);
    packing.slot_node.resize(count, -1);
    packing.slot_part.resize(count, part_row);
    packing.next_slot.resize(count, -1);
    for (Index i = 0; i < part.slots; ++i) {
        const std::size_t old = row(from + i), now = row(part.first_slot + i);
        unlink_slot(packing, from + i);
        packing.rest[now] = packing.rest[old];
        packing.position[now] = packing.position[old];
        packing.slot_node[now] = packing.slot_node[old];
        link_slot(packing, part.first_slot + i);
    }
}

} // namespace

void reserve_slots(Packing& packing, Index part, Index nodes) {
    make_room(packing, part, nodes + nodes / spare_share + spare_slots);
}

Index slot_for(Packing& packing, const NodeArrays& nodes, Index part_row, Index node) {
    if (row(node) >= packing.first_slot.size()) { packing.first_slot.resize(nodes.rest.size(), -1); }
    const Index found = find_slot(packing, part_row, node);
    if (found >= 0) { return found; }
    if (packing.parts[row(part_row)].slots == packing.parts[row(part_row)].room) {
        make_room(packing, part_row, 2 * packing.parts[row(part_row)].room);
    }
    Part& part = packing.parts[row(part_row)];
    const Index slot = part.first_slot + part.slots++;
    const Vec3f& rest = nodes.rest[row(node)];
    packing.rest[row(slot)] = {quanta(rest[0], packing.quanta_a_metre),
                               quanta(rest[1], packing.quanta_a_metre),
                               quanta(rest[2], packing.quanta_a_metre), 0};
    packing.slot_node[row(slot)] = node;
    link_slot(packing, slot);
    place_node(packing, nodes, node);
    return slot;
}

/// From edges as the kernel sees them, so that the rest state is without force to rounding.
void write_tet(Packing& packing, const Elements& elements, Index copy) {
    const Seat& seat = packing.seats[row(copy)];
    const std::array<Index, 4> slot = slots_of(packing, seat);
    const Vec3 e1 = rest_edge(packing, slot[0], slot[1]);
    const Vec3 e2 = rest_edge(packing, slot[0], slot[2]);
    const Vec3 e3 = rest_edge(packing, slot[0], slot[3]);
    const Vec3 n1 = cross(e2, e3), n2 = cross(e3, e1), n3 = cross(e1, e2);
    const double determinant = dot(e1, n1);
    const ElementBlock& block = elements.blocks[row(copy / lanes)];
    const auto lane = copy % lanes;
    const double volume = double(block.volume[lane]) * double(packing.quanta_a_metre);
    const double stiffness = double(block.mu[lane]) * volume / (determinant * determinant);
    const double metric[6] = {dot(n1, n1), dot(n2, n2), dot(n3, n3), dot(n1, n2), dot(n1, n3), dot(n2, n3)};
    FanTets& to = packing.parts[row(seat.part)].tets[row(seat.tet)];
    for (int i = 0; i < 6; ++i) {
        to.metric[i][seat.lane] = static_cast<float>(stiffness * metric[i]);
    }
    to.inverse[seat.lane] = static_cast<float>(1 / determinant);
    to.resistance[seat.lane] = static_cast<float>(double(block.bulk[lane]) * volume / determinant);
}

void clear_tet(Packing& packing, const Seat& seat) {
    FanTets& tet = packing.parts[row(seat.part)].tets[row(seat.tet)];
    for (auto& entry : tet.metric) {
        entry[seat.lane] = 0;
    }
    tet.inverse[seat.lane] = 0;
    tet.resistance[seat.lane] = 0;
    packing.parts[row(seat.part)].copies[row(seat.tet)].at[seat.lane] = -1;
}

Index block_of(const Part& part, Index tet) {
    const auto after = std::upper_bound(part.blocks.begin(), part.blocks.end(), tet,
                                        [](Index t, const FanBlock& block) { return t < block.first_tet; });
    return static_cast<Index>(after - part.blocks.begin()) - 1;
}

std::array<Index, 4> slots_of(const Packing& packing, const Seat& seat) {
    const Part& part = packing.parts[row(seat.part)];
    const FanBlock& block = part.blocks[row(block_of(part, seat.tet))];
    const Index j = seat.tet - block.first_tet;
    const Index last = block.closed != 0 && j == block.length - 1 ? 2 : 3 + j;
    const auto slot = [&](Index node_row) {
        const unsigned offset = part.nodes[row(block.first_node + node_row)].at[seat.lane];
        return part.first_slot + static_cast<Index>(offset / sizeof(Row));
    };
    return {slot(0), slot(1), slot(2 + j), slot(last)};
}

void place_at(Packing& packing, Index node, const Vec3f& u, const Vec3f& v) {
    for (Index slot = packing.first_slot[row(node)]; slot >= 0; slot = packing.next_slot[row(slot)]) {
        const float time = packing.parts[row(packing.slot_part[row(slot)])].viscous_time;
        const auto along = [&](int rest, std::size_t axis) {
            return add(rest, add(quanta(u[axis], packing.quanta_a_metre),
                                 truncate(time * v[axis] * packing.quanta_a_metre)));
        };
        const Place& rest = packing.rest[row(slot)];
        packing.position[row(slot)] = {along(rest.x, 0), along(rest.y, 1), along(rest.z, 2), 0};
    }
}

void place_node(Packing& packing, const NodeArrays& nodes, Index node) {
    place_at(packing, node, nodes.displacement[row(node)], nodes.velocity[row(node)]);
}

void place_all_nodes(Packing& packing, const NodeArrays& nodes) {
    for (std::size_t node = 0; node < packing.first_slot.size(); ++node) {
        place_node(packing, nodes, static_cast<Index>(node));
    }
}

std::size_t bytes_of(const Packing& packing) {
    std::size_t bytes = packing.position.size() * (2 * sizeof(Place) + sizeof(Row) + 3 * sizeof(Index)) +
                        packing.seats.size() * sizeof(Seat) + packing.first_slot.size() * sizeof(Index);
    for (const Part& part : packing.parts) {
        bytes +=
            part.nodes.size() * sizeof(FanNodes) + part.tets.size() * (sizeof(FanTets) + sizeof(FanCopies));
    }
    return bytes;
}

std::string find_packing_fault(const Packing& packing, const Elements& elements) {
    if (packing.seats.size() != row(elements.count)) { return "copies without a seat"; }
    for (Index copy = 0; copy < elements.count; ++copy) {
        const Seat& seat = packing.seats[row(copy)];
        if (packing.parts[row(seat.part)].copies[row(seat.tet)].at[seat.lane] != copy) {
            return "a seat that another copy has taken";
        }
        Tet node = {};
        const std::array<Index, 4> slots = slots_of(packing, seat);
        for (std::size_t corner = 0; corner < 4; ++corner) {
            node[corner] = packing.slot_node[row(slots[corner])];
            if (find_slot(packing, seat.part, node[corner]) != slots[corner]) {
                return "a slot that is no node's";
            }
        }
        Tet expected = corners(elements, copy);
        std::sort(node.begin(), node.end());
        std::sort(expected.begin(), expected.end());
        if (node != expected) { return "a copy that hangs on other nodes in its fan"; }
    }
    Index seated = 0;
    for (const Part& part : packing.parts) {
        for (const FanCopies& row_of_copies : part.copies) {
            seated += static_cast<Index>(std::count_if(
                std::begin(row_of_copies.at), std::end(row_of_copies.at), [](Index c) { return c >= 0; }));
        }
    }
    return seated == elements.count ? "" : "a lane with a copy that sits elsewhere";
}

} // namespace resect
