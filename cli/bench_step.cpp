// SPDX-License-Identifier: Apache-2.0
#include "bench_step.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <thread>

#include "bench/machine.hpp"
#include "report.hpp"
#include "samples.hpp"

namespace cli {

namespace {

using namespace resect;
using Json = nlohmann::ordered_json;

constexpr int repeats = 15;
constexpr double sample_time = 0.1; // s of wall clock

struct NamedBody {
    std::string name = {};
    Body body = {};
};

/// Held at its left end, so that gravity deforms it as in use.
Setup hold_left(const Body& body, int threads) {
    double left = body.elements.nodes.front()[0];
    for (const Vec3& node : body.elements.nodes) {
        left = std::min(left, node[0]);
    }
    Setup setup{.body = body, .materials = {{.young = 5e4}}, .damping = 2, .threads = threads};
    const double depth = body.lattice_spacing > 0 ? 3 * body.lattice_spacing : 1e-6;
    setup.fixed = {{.box = {.lo = {left - 1, -10, -10}, .hi = {left + depth, 10, 10}}}};
    return setup;
}

/// The best of some samples, and the median.
Json measure(Simulation& simulation, std::size_t elements) {
    const double step = simulation.time_step().used;
    Samples rates;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        Timer timer;
        double wall = 0;
        std::int64_t steps = 0;
        while (wall < sample_time) {
            steps += simulation.advance(10 * step).steps;
            wall += timer.lap();
        }
        rates.add(static_cast<double>(steps) * static_cast<double>(elements) / wall);
    }
    const double best = rates.percentile(1);
    return {{"updates_per_s", {{"best", best}, {"median", rates.percentile(0.5)}}},
            {"step_us", 1e6 * static_cast<double>(elements) / best},
            {"real_time_factor", step * best / static_cast<double>(elements)}};
}

std::vector<NamedBody> bench_bodies(bool large) {
    std::vector<NamedBody> bodies;
    bodies.push_back({"block 6k", must(make_block({0.1, 0.1, 0.1}, {10, 10, 10}))});
    bodies.push_back({"block 50k", must(make_block({0.1, 0.1, 0.105}, {20, 20, 21}))});
    bodies.push_back({"liver 6097", must(make_liver({.elements = 6097}))});
    if (large) {
        bodies.push_back({"block 400k", must(make_block({0.1, 0.1, 0.105}, {40, 40, 42}))});
        bodies.push_back({"liver 100k", must(make_liver({.elements = 100000}))});
        bodies.push_back({"block 3M", must(make_block({0.1, 0.1, 0.0975}, {80, 80, 78}))});
    }
    return bodies;
}

std::set<int> thread_counts(int threads) {
    if (threads > 0) { return {threads}; }
    return {1, std::max(1, static_cast<int>(std::thread::hardware_concurrency()))};
}

/// The one that was asked for, or each that runs here, the best first.
std::vector<std::string> instruction_sets(const std::string& asked) {
    if (!asked.empty()) { return {asked}; }
    const std::string best = instruction_set();
    std::vector<std::string> sets;
    for (const char* set : {"avx512", "avx2", "sse2", "neon"}) {
        if (choose_instruction_set(set)) { sets.emplace_back(set); }
    }
    choose_instruction_set(best);
    return sets;
}

} // namespace

Json bench_step(const BenchOptions& options, bool talk) {
    Json json;
    json["read_bytes_per_s"] = bench::measure_read_bandwidth();
    const std::vector<std::string> sets = instruction_sets(options.isa);
    for (const std::string& set : sets) {
        json["flops"][set] = bench::measure_flops(set);
    }
    if (talk) {
        fmt::print("step  one core: {:.0f} GFLOP/s ({}), reads {:.1f} GB/s\n",
                   1e-9 * json["flops"][sets.front()].get<double>(), sets.front(),
                   1e-9 * json["read_bytes_per_s"].get<double>());
    }
    for (const NamedBody& named : bench_bodies(options.large)) {
        const std::size_t elements = named.body.elements.tets.size();
        for (const int threads : thread_counts(options.threads)) {
            Simulation simulation = must(Simulation::create(hold_left(named.body, threads)));
            simulation.advance(50 * simulation.time_step().used);
            for (const std::string& set : sets) {
                choose_instruction_set(set);
                Json row = {{"mesh", named.name}, {"elements", elements}, {"threads", threads}, {"isa", set}};
                row.update(measure(simulation, elements));
                if (talk) {
                    fmt::print("step  {:10} {} thread(s), {:6}: {:6.1f} M element updates/s (median {:.1f}), "
                               "{:8.1f} us a step, {:6.1f} times real time\n",
                               named.name, threads, set, 1e-6 * row["updates_per_s"]["best"].get<double>(),
                               1e-6 * row["updates_per_s"]["median"].get<double>(),
                               row["step_us"].get<double>(), row["real_time_factor"].get<double>());
                }
                json["rows"].push_back(row);
            }
            choose_instruction_set(sets.front());
        }
    }
    return json;
}

} // namespace cli
