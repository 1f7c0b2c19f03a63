// SPDX-License-Identifier: Apache-2.0
#include "bench_step.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <thread>

#include "bench/machine.hpp"
#include "bench/stages.hpp"
#include "bench/unstructured.hpp"
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

/// A body that is run by a number of threads with an instruction set.
struct Course {
    Simulation& simulation;
    int threads = 0;
    std::string isa = {};
    Samples rates = {}; // element updates a second
};

double sample_rate(Course& course, std::size_t elements) {
    choose_instruction_set(course.isa);
    const double step = course.simulation.time_step().used;
    Timer timer;
    double wall = 0;
    std::int64_t steps = 0;
    while (wall < sample_time) {
        steps += course.simulation.advance(10 * step).steps;
        wall += timer.lap();
    }
    return static_cast<double>(steps) * static_cast<double>(elements) / wall;
}

/// In turn, so that what else the machine does meets them all.
void run_in_turn(std::vector<Course>& courses, std::size_t elements) {
    for (int repeat = 0; repeat < repeats; ++repeat) {
        for (Course& course : courses) {
            course.rates.add(sample_rate(course, elements));
        }
    }
}

Json stages_of(Course& course) {
    choose_instruction_set(course.isa);
    const bench::Stages stages = bench::measure_stages(course.simulation);
    return {{"forces_us", stages.forces_us},
            {"nodes_us", stages.nodes_us},
            {"flops_an_element", stages.flops_an_element},
            {"bytes_an_element", stages.bytes_an_element}};
}

Json describe(const NamedBody& named, Course& course) {
    const auto elements = static_cast<double>(named.body.elements.tets.size());
    const double best = course.rates.percentile(1);
    return {{"mesh", named.name},
            {"elements", named.body.elements.tets.size()},
            {"threads", course.threads},
            {"isa", course.isa},
            {"updates_per_s", {{"best", best}, {"median", course.rates.percentile(0.5)}}},
            {"step_us", 1e6 * elements / best},
            {"real_time_factor", course.simulation.time_step().used * best / elements},
            {"stages", stages_of(course)}};
}

/// Shares of what the cores can do at most, of which one does `flops` and reads `bytes` a second.
void add_ceilings(Json& row, double flops, double bytes) {
    const double rate = row["updates_per_s"]["best"], threads = row["threads"];
    row["share_of_flops"] = rate * row["stages"]["flops_an_element"].get<double>() / (threads * flops);
    row["share_of_read_bandwidth"] = rate * row["stages"]["bytes_an_element"].get<double>() / bytes;
}

void print_row(const Json& row) {
    fmt::print(
        "step  {:17} {} thread(s), {:6}: {:6.1f} M element updates/s (median {:.1f}), {:8.1f} us a step "
        "(forces {:.1f}, nodes {:.1f}), {:3.0f} % of FMA, {:3.0f} % of reads, {:6.1f} times real time\n",
        row["mesh"].get<std::string>(), row["threads"].get<int>(), row["isa"].get<std::string>(),
        1e-6 * row["updates_per_s"]["best"].get<double>(),
        1e-6 * row["updates_per_s"]["median"].get<double>(), row["step_us"].get<double>(),
        row["stages"]["forces_us"].get<double>(), row["stages"]["nodes_us"].get<double>(),
        100 * row["share_of_flops"].get<double>(), 100 * row["share_of_read_bandwidth"].get<double>(),
        row["real_time_factor"].get<double>());
}

std::vector<NamedBody> bench_bodies(bool large) {
    std::vector<NamedBody> bodies;
    bodies.push_back({"block 6k", must(make_block({0.1, 0.1, 0.1}, {10, 10, 10}))});
    bodies.push_back({"block 50k", must(make_block({0.1, 0.1, 0.105}, {20, 20, 21}))});
    bodies.push_back({"unstructured 50k", bench::make_unstructured_cube(19, 1)});
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
    const double bytes = bench::measure_read_bandwidth();
    json["read_bytes_per_s"] = bytes;
    const std::vector<std::string> sets = instruction_sets(options.isa);
    for (const std::string& set : sets) {
        json["flops"][set] = bench::measure_flops(set);
    }
    if (talk) {
        fmt::print("step  one core: {:.0f} GFLOP/s ({}), reads {:.1f} GB/s\n",
                   1e-9 * json["flops"][sets.front()].get<double>(), sets.front(), 1e-9 * bytes);
    }
    for (const NamedBody& named : bench_bodies(options.large)) {
        std::vector<Simulation> simulations;
        for (const int threads : thread_counts(options.threads)) {
            simulations.push_back(must(Simulation::create(hold_left(named.body, threads))));
            simulations.back().advance(50 * simulations.back().time_step().used);
        }
        std::vector<Course> courses;
        std::size_t next = 0;
        for (const int threads : thread_counts(options.threads)) {
            Simulation& simulation = simulations[next++];
            for (const std::string& set : sets) {
                courses.push_back({simulation, threads, set});
            }
        }
        run_in_turn(courses, named.body.elements.tets.size());
        for (Course& course : courses) {
            Json row = describe(named, course);
            add_ceilings(row, json["flops"][course.isa], bytes);
            if (talk) { print_row(row); }
            json["rows"].push_back(row);
        }
        choose_instruction_set(sets.front());
    }
    return json;
}

} // namespace cli
