// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/index.hpp"
#include "fem/choose_kernels.hpp"
#include "fem/deformation.hpp"
#include "fem/pack_rows.hpp"
#include "fem/step.hpp"

namespace resect {
namespace {

/// Whom the kernel calls for what it does not do.
struct BeyondRange {
    const Elements& elements;
    Packing& packing;
    Index part;
};

void add_force(Packing& packing, Index slot, const Vec3f& force) {
    Row& to = packing.force[row(slot)];
    to.x += force[0];
    to.y += force[1];
    to.z += force[2];
}

/// The copy's slots in the order of its corners.
std::array<Index, 4> corner_slots(const Packing& packing, const Elements& elements, Index copy) {
    std::array<Index, 4> slots = {};
    const Tet node = corners(elements, copy);
    for (std::size_t corner = 0; corner < 4; ++corner) {
        slots[corner] = find_slot(packing, packing.seats[row(copy)].part, node[corner]);
    }
    return slots;
}

/// f_k = V P grad N_k by the whole law; the four forces of an element are in balance.
void add_forces_beyond_range(const Elements& elements, Packing& packing, Index copy) {
    const ElementBlock& block = elements.blocks[row(copy / lanes)];
    const Index lane = copy % lanes;
    const std::array<Index, 4> slots = corner_slots(packing, elements, copy);
    double edge[3][3] = {}, gradient[3][3] = {};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 to = (1 / double(packing.quanta_a_metre)) *
                        difference(packing.position[row(slots[k + 1])], packing.position[row(slots[0])]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            edge[k][axis] = to[axis];
            gradient[k][axis] = double(block.gradient[k][axis][lane]);
        }
    }
    Matrix3<double> H = displacement_gradient(edge, gradient); // F, from the edges of now
    for (int i = 0; i < 3; ++i) {
        H.at[i][i] -= 1;
    }
    const Deformation<double> at = deformation(H);
    const Matrix3<double> P = stress(at, law(at.now, moduli_of(elements, copy)));
    Vec3f others = {};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto along = [&](int axis) {
            const auto& g = gradient[k];
            return static_cast<float>(double(block.volume[lane]) *
                                      (P.at[axis][0] * g[0] + P.at[axis][1] * g[1] + P.at[axis][2] * g[2]));
        };
        const Vec3f force = {along(0), along(1), along(2)};
        add_force(packing, slots[k + 1], force);
        others += force;
    }
    add_force(packing, slots[0], -1.0F * others);
}

void add_block_beyond_range(void* caller, int block_row, const FansBeyond& beyond) {
    const BeyondRange& range = *static_cast<BeyondRange*>(caller);
    const Part& part = range.packing.parts[row(range.part)];
    const FanBlock& block = part.blocks[row(block_row)];
    for (int j = 0; j < block.length; ++j) {
        for (int lane = 0; lane < fan_lanes; ++lane) {
            if (beyond.tet[j][lane] == 0) { continue; }
            add_forces_beyond_range(range.elements, range.packing,
                                    part.copies[row(block.first_tet + j)].at[lane]);
        }
    }
}

} // namespace

void element_forces(const Elements& elements, Packing& packing, Index part_row) {
    const Part& part = packing.parts[row(part_row)];
    const auto force = packing.force.begin() + part.first_slot;
    std::fill(force, force + part.slots, Row{});
    BeyondRange beyond{elements, packing, part_row};
    kernels().add_forces({.blocks = part.blocks.data(),
                          .block_count = static_cast<int>(part.blocks.size()),
                          .nodes = part.nodes.data(),
                          .tets = part.tets.data(),
                          .position = packing.position.data() + part.first_slot,
                          .force = packing.force.data() + part.first_slot,
                          .beyond = add_block_beyond_range,
                          .caller = &beyond});
}

} // namespace resect
