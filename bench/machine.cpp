// SPDX-License-Identifier: Apache-2.0
#include "bench/machine.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace bench {

namespace {

constexpr std::size_t chains = 12; // independent ones, enough to hide the latency of each
constexpr int rounds = 20000;
constexpr int samples = 20;

template <std::size_t Lanes>
struct Chains {
    float at[chains][Lanes];
};

#if defined(__x86_64__)
#define RESECT_BENCH_TARGET(name) [[gnu::target(name)]]
#else
#define RESECT_BENCH_TARGET(name)
#endif

RESECT_BENCH_TARGET("avx512f,fma") [[gnu::noinline]] void turn(Chains<16>& x) {
    for (int round = 0; round < rounds; ++round) {
        for (auto& chain : x.at) {
            for (float& value : chain) {
                value = __builtin_fmaf(value, 0.999F, 0.001F);
            }
        }
    }
}
RESECT_BENCH_TARGET("avx2,fma") [[gnu::noinline]] void turn(Chains<8>& x) {
    for (int round = 0; round < rounds; ++round) {
        for (auto& chain : x.at) {
            for (float& value : chain) {
                value = __builtin_fmaf(value, 0.999F, 0.001F);
            }
        }
    }
}
[[gnu::noinline]] void turn(Chains<4>& x) {
    for (int round = 0; round < rounds; ++round) {
        for (auto& chain : x.at) {
            for (float& value : chain) {
                value = value * 0.999F + 0.001F;
            }
        }
    }
}

template <class Work>
double least_seconds(Work work) {
    double least = 1e30;
    for (int sample = 0; sample < samples; ++sample) {
        const auto begin = std::chrono::steady_clock::now();
        work();
        least =
            std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    return least;
}

template <std::size_t Lanes>
double flops() {
    Chains<Lanes> x = {};
    return 2.0 * double{chains * Lanes} * rounds / least_seconds([&] { turn(x); });
}

} // namespace

double measure_flops(const std::string& instruction_set) {
    if (instruction_set == "avx512") { return flops<16>(); }
    return instruction_set == "avx2" ? flops<8>() : flops<4>();
}

double measure_read_bandwidth() {
    const std::vector<std::uint64_t> values(std::size_t{1} << 25U, 1); // 256 MiB
    volatile std::uint64_t sum = 0;
    const double seconds =
        least_seconds([&] { sum = std::accumulate(values.begin(), values.end(), std::uint64_t{0}); });
    return static_cast<double>(values.size() * sizeof(std::uint64_t)) / seconds;
}

} // namespace bench
