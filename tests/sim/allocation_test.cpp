// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cstdlib>
#include <doctest/doctest.h>
#include <new>

#include "bodies.hpp"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__clang__)

namespace {
std::atomic<long> allocations{0};
}

void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size)) { return memory; }
    throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    ++allocations;
    const auto to = static_cast<std::size_t>(alignment);
    if (void* memory = std::aligned_alloc(to, (size + to - 1) / to * to)) { return memory; }
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

using namespace resect;

TEST_CASE("a step in which no blade cuts allocates nothing") {
    for (const int threads : {1, 2}) {
        Setup setup = held_block(8);
        setup.threads = threads;
        setup.gravity = {0, 0, -9.81};
        Simulation simulation = must(Simulation::create(std::move(setup)));
        must(simulation.apply(MoveBlade{.to = edge_above(0.05, 0.5)})); // in the air
        const double step = simulation.time_step().used;
        simulation.advance(1000 * step); // both looks at the strain
        const long before = allocations;
        simulation.advance(1200 * step);
        CHECK(allocations == before);
    }
}

#endif
