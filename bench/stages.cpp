// SPDX-License-Identifier: Apache-2.0
#include "bench/stages.hpp"

#include <algorithm>
#include <chrono>

#include "sim/engine.hpp"

namespace bench {

namespace {

using namespace resect;

constexpr int samples = 15;
constexpr double sample_time = 0.02; // s

/// Counted in fem/kernel_source.inc, walk() and neo_hookean(): two cross products 18, three products with the
/// metric 45, I1 17, J 5, the law 28, forces 36.
constexpr double flops_a_tet = 149;

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <class Work>
double least_us(Work work) {
    double least = 1e30;
    for (int sample = 0; sample < samples; ++sample) {
        int runs = 0;
        const auto begin = std::chrono::steady_clock::now();
        do {
            work();
            ++runs;
        } while (seconds_since(begin) < sample_time);
        least = std::min(least, 1e6 * seconds_since(begin) / runs);
    }
    return least;
}

std::size_t bytes_of_step(const Engine& engine) {
    std::size_t bytes = 0;
    for (const Part& part : engine.packing.parts) {
        for (const FanBlock& block : part.blocks) {
            bytes += row(block.length) * sizeof(FanTets) + row(block.length + 3) * sizeof(FanNodes);
        }
        // Read: position, rest, force, links; written: position, force twice.
        bytes += row(part.slots) * (3 * sizeof(Place) + 3 * sizeof(Row) + 2 * sizeof(Index));
    }
    // Read: displacement, velocity, load, masses; written: displacement, velocity.
    return bytes + engine.nodes.mass.size() * (5 * sizeof(Vec3f) + 2 * sizeof(float));
}

} // namespace

Stages measure_stages(Simulation& simulation) {
    Engine& engine = engine_of(simulation);
    Stages stages;
    stages.forces_us = least_us([&] { compute_forces(engine); });
    stages.nodes_us = least_us([&] { update_nodes(engine); });
    place_all_nodes(engine.packing, engine.nodes);
    const double elements = static_cast<double>(engine.elements.count);
    stages.flops_an_element = flops_a_tet;
    stages.bytes_an_element = static_cast<double>(bytes_of_step(engine)) / elements;
    return stages;
}

} // namespace bench
