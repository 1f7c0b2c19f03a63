// SPDX-License-Identifier: Apache-2.0
#include "cut/weigh.hpp"

namespace resect {

void weigh_element(Cutter& cutter, Index element) {
    SimulationMesh& mesh = cutter.mesh;
    const double fill = cutter.element_fill[row(element)];
    const double whole = cutter.element_weight[row(element)];
    const Index first = cutter.first_copy[row(element)];
    Index count = 0;
    for (Index c = first; c >= 0; c = cutter.sibling[row(c)]) {
        ++count;
    }
    if (count == 1 || cutter.setup.options.weights == Weights::copy) {
        for (Index c = first; c >= 0; c = cutter.sibling[row(c)]) {
            mesh.copy_weight.edit(row(c)) = whole;
        }
        return;
    }
    // Light copies are driven by the heavy ones around them, crushed and inverted: hence the floor.
    const double floor = weight_floor(count);
    const auto above = [&](Index c) { return std::max(0.0, mesh.copy_fraction[row(c)] / fill - floor); };
    double sum = 0;
    for (Index c = first; c >= 0; c = cutter.sibling[row(c)]) {
        sum += above(c);
    }
    for (Index c = first; c >= 0; c = cutter.sibling[row(c)]) {
        mesh.copy_weight.edit(row(c)) = whole * (floor + above(c) * (1 - count * floor) / sum);
    }
}

double sum_mass(const Cutter& cutter, std::span<const Index> pairs) {
    double mass = 0;
    for (const Index pair : pairs) {
        const std::size_t copy = row(pair / 4);
        const std::size_t element = row(cutter.mesh.copy_element[copy]);
        mass += cutter.mesh.copy_weight[copy] * cutter.setup.element_mass[element] / 4;
    }
    return mass;
}

} // namespace resect
