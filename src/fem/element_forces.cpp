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
    const NodeArrays& nodes;
    Packing& packing;
    Index part;
};

void add_force(Packing& packing, Index slot, const Vec3f& force) {
    Row& to = packing.force[row(slot)];
    to.x += force[0];
    to.y += force[1];
    to.z += force[2];
}

/// f_k = V P grad N_k by the whole law at u + viscous_time v; the four forces of an element are in balance.
/// From displacements, since edges that are 32 times as long as any at rest are beyond what positions tell.
void add_forces_beyond_range(const BeyondRange& range, Index copy) {
    Packing& packing = range.packing;
    const ElementBlock& block = range.elements.blocks[row(copy / lanes)];
    const Index lane = copy % lanes;
    const Tet node = corners(range.elements, copy);
    const double viscous_time = double(packing.parts[row(range.part)].viscous_time);
    const auto ahead = [&](std::size_t corner) {
        const std::size_t n = row(node[corner]);
        return to_double(range.nodes.displacement[n]) + viscous_time * to_double(range.nodes.velocity[n]);
    };
    const Vec3 base = ahead(0);
    double relative[3][3] = {}, gradient[3][3] = {};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 u = ahead(k + 1) - base;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            relative[k][axis] = u[axis];
            gradient[k][axis] = double(block.gradient[k][axis][lane]);
        }
    }
    const Deformation<double> at = deformation(displacement_gradient(relative, gradient));
    if (!is_trusted(at.now)) { packing.parts[row(range.part)].left_range.push_back(copy); }
    const Matrix3<double> P = stress(at, law(at.now, moduli_of(range.elements, copy)));
    const auto slot_of = [&](std::size_t corner) { return find_slot(packing, range.part, node[corner]); };
    Vec3f others = {};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto along = [&](int axis) {
            const auto& g = gradient[k];
            return static_cast<float>(double(block.volume[lane]) *
                                      (P.at[axis][0] * g[0] + P.at[axis][1] * g[1] + P.at[axis][2] * g[2]));
        };
        const Vec3f force = {along(0), along(1), along(2)};
        add_force(packing, slot_of(k + 1), force);
        others += force;
    }
    add_force(packing, slot_of(0), -1.0F * others);
}

void add_block_beyond_range(void* caller, int block_row, const FansBeyond& beyond) {
    const BeyondRange& range = *static_cast<BeyondRange*>(caller);
    const Part& part = range.packing.parts[row(range.part)];
    const FanBlock& block = part.blocks[row(block_row)];
    for (int j = 0; j < block.length; ++j) {
        for (int lane = 0; lane < fan_lanes; ++lane) {
            if (beyond.tet[j][lane] == 0) { continue; }
            add_forces_beyond_range(range, part.copies[row(block.first_tet + j)].at[lane]);
        }
    }
}

} // namespace

void element_forces(const Elements& elements, const NodeArrays& nodes, Packing& packing, Index part_row) {
    Part& part = packing.parts[row(part_row)];
    part.left_range.clear();
    const auto force = packing.force.begin() + part.first_slot;
    std::fill(force, force + part.slots, Row{});
    BeyondRange beyond{elements, nodes, packing, part_row};
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
