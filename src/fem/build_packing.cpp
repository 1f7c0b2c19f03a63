// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/index.hpp"
#include "base/reserve.hpp"
#include "fem/fans.hpp"
#include "fem/pack_rows.hpp"

namespace resect {
namespace {

constexpr Index copies_a_part = 3000;
constexpr Index parts_at_most = 64;
constexpr Index copies_a_cell = 1280;
constexpr Index copies_a_leaf = 32; // of the order within a part

float viscous_time_of(const Elements& elements, Index copy) {
    return elements.blocks[row(copy / lanes)].viscous_time[copy % lanes];
}

/// A copy and where it is.
struct PlacedCopy {
    Index copy;
    Vec3f at; // m, four times its centre
};

std::vector<PlacedCopy> place_copies(const Elements& elements, const NodeArrays& nodes,
                                     std::span<const Index> copies) {
    std::vector<PlacedCopy> places;
    places.reserve(copies.size());
    for (const Index copy : copies) {
        Vec3f sum = {};
        for (const Index node : corners(elements, copy)) {
            sum += nodes.rest[row(node)];
        }
        places.push_back({copy, sum});
    }
    return places;
}

/// Where the first `count` copies along the longest axis end.
void halve(std::span<PlacedCopy> places, std::size_t count) {
    Vec3f lo = places.front().at, hi = lo;
    for (const PlacedCopy& place : places) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lo[axis] = std::min(lo[axis], place.at[axis]);
            hi[axis] = std::max(hi[axis], place.at[axis]);
        }
    }
    const Vec3f size = hi - lo;
    const auto axis = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
    std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(count), places.end(),
                     [axis](const PlacedCopy& p, const PlacedCopy& q) {
                         return p.at[axis] != q.at[axis] ? p.at[axis] < q.at[axis] : p.copy < q.copy;
                     });
}

/// So that copies that follow one another lie together.
void sort_by_place(std::span<PlacedCopy> places) {
    if (places.size() <= row(copies_a_leaf)) {
        std::sort(places.begin(), places.end(),
                  [](const PlacedCopy& p, const PlacedCopy& q) { return p.copy < q.copy; });
        return;
    }
    const std::size_t half = places.size() / 2;
    halve(places, half);
    sort_by_place(places.first(half));
    sort_by_place(places.subspan(half));
}

void split(std::span<PlacedCopy> places, Index parts, std::vector<std::vector<Index>>& to) {
    if (parts > 1) {
        const Index low = parts / 2;
        const std::size_t count = places.size() * row(low) / row(parts);
        halve(places, count);
        split(places.first(count), low, to);
        split(places.subspan(count), parts - low, to);
        return;
    }
    sort_by_place(places);
    std::vector<Index>& copies = to.emplace_back();
    for (const PlacedCopy& place : places) {
        copies.push_back(place.copy);
    }
}

using CopiesByTime = std::map<float, std::vector<PlacedCopy>>; // viscous time, s

CopiesByTime place_by_time(const Elements& elements, const NodeArrays& nodes) {
    std::map<float, std::vector<Index>> by_time;
    for (Index copy = 0; copy < elements.count; ++copy) {
        by_time[viscous_time_of(elements, copy)].push_back(copy);
    }
    CopiesByTime places;
    for (const auto& [time, copies] : by_time) {
        places[time] = place_copies(elements, nodes, copies);
    }
    return places;
}

/// Copies by part, in the order of their places, of one viscous time each. Sorts them, too.
std::vector<std::vector<Index>> divide(CopiesByTime& copies) {
    std::vector<std::vector<Index>> parts;
    for (auto& [time, places] : copies) {
        const auto count = static_cast<Index>(places.size()) / copies_a_part;
        split(places, std::clamp<Index>(count, 1, parts_at_most), parts);
    }
    return parts;
}

/// A power of two, so that scaling rounds nothing: the longest edge has 2^25 to 2^26 quanta, and may grow to
/// 32 times its length before differences are no longer told apart.
float choose_quanta(const Elements& elements, const NodeArrays& nodes) {
    constexpr int edge_bits = 26;
    float longest = 0;
    for (Index copy = 0; copy < elements.count; ++copy) {
        const Tet tet = corners(elements, copy);
        for (const auto& edge : edge_corners) {
            const Vec3f along = nodes.rest[row(tet[row(edge[1])])] - nodes.rest[row(tet[row(edge[0])])];
            longest = std::max(longest, dot(along, along));
        }
    }
    return std::ldexp(1.0F, edge_bits - std::ilogb(std::sqrt(longest)) - 1);
}

std::vector<Index> find_nodes(const Elements& elements, std::span<const Index> copies) {
    std::vector<Index> nodes;
    for (const Index copy : copies) {
        const Tet tet = corners(elements, copy);
        nodes.insert(nodes.end(), tet.begin(), tet.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

/// Room for what cuts add.
void reserve_rows(Part& part) {
    reserve_ahead(part.blocks, 2);
    reserve_ahead(part.nodes, 2);
    reserve_ahead(part.tets, 2);
    reserve_ahead(part.copies, 2);
    part.spare.reserve(64);
    part.left_range.reserve(64);
    for (Cell& cell : part.cells) {
        reserve_ahead(cell.copies, 2);
    }
}

/// Covers copies by fans and adds their blocks, those of one material after the other; they sit nowhere.
void pack_copies(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part,
                 std::span<const Index> copies) {
    std::map<float, std::vector<Index>> by_material;
    for (const Index copy : copies) {
        by_material[shear_over_resistance(elements, copy)].push_back(copy);
    }
    for (const auto& [ratio, alike] : by_material) {
        std::vector<Tet> tets;
        for (const Index copy : alike) {
            tets.push_back(corners(elements, copy));
        }
        std::vector<Fan> fans = cover_with_fans(tets, nodes.rest);
        for (Fan& fan : fans) {
            for (Index j = 0; j < fan.length; ++j) {
                fan.tet[row(j)] = alike[row(fan.tet[row(j)])];
            }
        }
        append_fans(packing, elements, nodes, part, fans, ratio);
    }
}

/// Cells of blocks that follow one another.
void divide_part(Packing& packing, Part& part) {
    for (const FanBlock& block : part.blocks) {
        if (part.cells.empty() || std::ssize(part.cells.back().copies) >= copies_a_cell) {
            part.cells.emplace_back();
        }
        for (Index tet = block.first_tet; tet < block.first_tet + block.length; ++tet) {
            for (const Index copy : part.copies[row(tet)].at) {
                if (copy < 0) { continue; }
                part.cells.back().copies.push_back(copy);
                packing.seats[row(copy)].cell = static_cast<Index>(part.cells.size()) - 1;
            }
        }
    }
}

} // namespace

void sort_apart(const Elements& elements, const NodeArrays& nodes, std::span<Index> copies,
                std::size_t count) {
    std::vector<PlacedCopy> places = place_copies(elements, nodes, copies);
    halve(places, count);
    std::transform(places.begin(), places.end(), copies.begin(),
                   [](const PlacedCopy& place) { return place.copy; });
}

void pack_cell(Packing& packing, const Elements& elements, const NodeArrays& nodes, Index part, Index cell) {
    pack_copies(packing, elements, nodes, part, packing.parts[row(part)].cells[row(cell)].copies);
    packing.parts[row(part)].cells[row(cell)].moved = 0;
}

std::vector<Index> order_nodes(const TetMesh& elements, std::span<const float> viscous_time) {
    CopiesByTime places;
    for (std::size_t element = 0; element < elements.tets.size(); ++element) {
        Vec3f sum = {};
        for (const Index node : elements.tets[element]) {
            sum += to_float(elements.nodes[row(node)]);
        }
        places[viscous_time[element]].push_back({static_cast<Index>(element), sum});
    }
    const std::vector<std::vector<Index>> parts = divide(places);
    std::vector<std::vector<Index>> parts_of(elements.nodes.size());
    for (std::size_t part = 0; part < parts.size(); ++part) {
        for (const Index element : parts[part]) {
            for (const Index node : elements.tets[row(element)]) {
                std::vector<Index>& of_node = parts_of[row(node)];
                if (of_node.empty() || row(of_node.back()) != part) {
                    of_node.push_back(static_cast<Index>(part));
                }
            }
        }
    }
    std::vector<Index> order(elements.nodes.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](Index p, Index q) {
        const std::vector<Index>&of_p = parts_of[row(p)], &of_q = parts_of[row(q)];
        return of_p.size() != of_q.size() ? of_p.size() < of_q.size() : of_p < of_q;
    });
    return order;
}

Packing build_packing(const Elements& elements, const NodeArrays& nodes) {
    Packing packing;
    packing.seats.resize(row(elements.count));
    packing.quanta_a_metre = choose_quanta(elements, nodes);
    packing.first_slot.assign(nodes.rest.size(), -1);
    CopiesByTime places = place_by_time(elements, nodes);
    const std::vector<std::vector<Index>> parts = divide(places);
    for (const std::vector<Index>& copies : parts) {
        Part part;
        part.viscous_time = viscous_time_of(elements, copies.front());
        packing.one_viscous_time =
            packing.one_viscous_time &&
            (packing.parts.empty() || packing.parts.front().viscous_time == part.viscous_time);
        packing.parts.push_back(std::move(part));
        const Index index = static_cast<Index>(packing.parts.size()) - 1;
        const std::vector<Index> used = find_nodes(elements, copies);
        reserve_slots(packing, index, static_cast<Index>(used.size()));
        for (const Index node : used) {
            slot_for(packing, nodes, index, node);
        }
        pack_copies(packing, elements, nodes, index, copies);
        divide_part(packing, packing.parts.back());
        reserve_rows(packing.parts.back());
    }
    return packing;
}

} // namespace resect
