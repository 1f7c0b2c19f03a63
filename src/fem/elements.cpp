// SPDX-License-Identifier: Apache-2.0
#include "fem/elements.hpp"

#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "fem/law.hpp"

namespace resect {
namespace {

/// Room for one more copy: a neutral lane.
Index append_lane(Elements& elements) {
    const Index copy = elements.count++;
    if (copy % lanes == 0) { elements.blocks.push_back(ElementBlock{}); }
    return copy;
}

} // namespace

RestElement build_rest_element(const TetMesh& mesh, const Tet& tet) {
    RestElement rest;
    rest.volume = signed_volume(mesh, tet);
    for (std::size_t corner = 0; corner < 4; ++corner) {
        // The normal of the face opposite the corner, of twice its area, points away from the corner.
        const auto& face = face_corners[corner];
        const auto at = [&](int k) { return mesh.nodes[row(tet[row(face[k])])]; };
        const Vec3 normal = cross(at(1) - at(0), at(2) - at(0));
        rest.gradient[corner] = (-1 / (6 * rest.volume)) * normal;
    }
    return rest;
}

std::vector<RestElement> build_rest(const TetMesh& mesh) {
    std::vector<RestElement> rest;
    rest.reserve(mesh.tets.size());
    for (const Tet& tet : mesh.tets) {
        rest.push_back(build_rest_element(mesh, tet));
    }
    return rest;
}

double rest_step_bound(const RestElement& rest, const Material& material) {
    const Moduli m = moduli(material);
    const double p_wave_modulus = m.bulk + 4 * m.mu / 3;
    double sum = 0; // |grad N_i| = 1 / h_i
    for (const Vec3& gradient : rest.gradient) {
        sum += dot(gradient, gradient);
    }
    return 1 / std::sqrt(p_wave_modulus / material.density * sum);
}

void append_copy(Elements& elements, const RestElement& rest, const Material& material,
                 const CopyOptions& options) {
    set_copy(elements, append_lane(elements), rest, material, options);
}

void set_copy(Elements& elements, Index copy, const RestElement& rest, const Material& material,
              const CopyOptions& options) {
    RESECT_ASSERT(0 <= copy && copy < elements.count);
    const Index lane = copy % lanes;
    ElementBlock& block = elements.blocks[row(copy / lanes)];
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            block.gradient[k][axis][lane] = static_cast<float>(rest.gradient[k + 1][axis]);
        }
    }
    for (Index corner = 0; corner < 4; ++corner) {
        block.node[corner][lane] = options.nodes[row(corner)];
    }
    block.viscous_time[lane] = static_cast<float>(options.viscous_time);
    set_moduli(elements, copy, moduli(material));
    set_weight(elements, copy, options.weight, rest.volume);
}

void append_copy_of(Elements& elements, Index parent) {
    RESECT_ASSERT(0 <= parent && parent < elements.count);
    const Index lane = append_lane(elements) % lanes;
    ElementBlock& block = elements.blocks.back();
    const ElementBlock& from_block = elements.blocks[row(parent / lanes)];
    const Index from = parent % lanes;
    for (int corner = 0; corner < 4; ++corner) {
        block.node[corner][lane] = from_block.node[corner][from];
    }
    for (int k = 0; k < 3; ++k) {
        for (int axis = 0; axis < 3; ++axis) {
            block.gradient[k][axis][lane] = from_block.gradient[k][axis][from];
        }
    }
    block.volume[lane] = from_block.volume[from];
    block.mu[lane] = from_block.mu[from];
    block.bulk[lane] = from_block.bulk[from];
    block.viscous_time[lane] = from_block.viscous_time[from];
    block.wall[lane] = from_block.wall[from];
}

void set_weight(Elements& elements, Index copy, double weight, double volume) {
    RESECT_ASSERT(0 <= copy && copy < elements.count);
    elements.blocks[row(copy / lanes)].volume[copy % lanes] = static_cast<float>(weight * volume);
}

void set_moduli(Elements& elements, Index copy, const Moduli& moduli) {
    RESECT_ASSERT(0 <= copy && copy < elements.count);
    ElementBlock& block = elements.blocks[row(copy / lanes)];
    const Index lane = copy % lanes;
    block.mu[lane] = static_cast<float>(moduli.mu);
    block.bulk[lane] = static_cast<float>(moduli.bulk);
    block.wall[lane] = static_cast<float>(moduli.wall);
}

Moduli moduli_of(const Elements& elements, Index copy) {
    RESECT_ASSERT(0 <= copy && copy < elements.count);
    const ElementBlock& block = elements.blocks[row(copy / lanes)];
    const Index lane = copy % lanes;
    return {double(block.mu[lane]), double(block.bulk[lane]), double(block.wall[lane])};
}

void set_corner(Elements& elements, Index copy, Index corner, Index node) {
    RESECT_ASSERT(0 <= copy && copy < elements.count && 0 <= corner && corner < 4);
    elements.blocks[row(copy / lanes)].node[corner][copy % lanes] = node;
}

Tet corners(const Elements& elements, Index copy) {
    const ElementBlock& block = elements.blocks[row(copy / lanes)];
    const Index lane = copy % lanes;
    return {block.node[0][lane], block.node[1][lane], block.node[2][lane], block.node[3][lane]};
}

} // namespace resect
