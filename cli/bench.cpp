// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>

#include "bench_cut.hpp"
#include "bench_fuzz.hpp"
#include "bench_matrix.hpp"
#include "options.hpp"
#include "report.hpp"
#include "samples.hpp"

namespace cli {

namespace {

using namespace resect;
using Json = nlohmann::ordered_json;

constexpr int repeats = 5;
constexpr double sample_time = 0.2; // s of wall clock

struct NamedBody {
    std::string name = {};
    Body body = {};
};

/// Held at its left end, so that gravity deforms it as in use.
Setup hold_left(Body body, int threads) {
    double left = body.elements.nodes.front()[0];
    for (const Vec3& node : body.elements.nodes) {
        left = std::min(left, node[0]);
    }
    Setup setup{.body = std::move(body), .damping = 2, .threads = threads};
    const double depth = setup.body.lattice_spacing > 0 ? 3 * setup.body.lattice_spacing : 1e-6;
    setup.fixed = {{.box = {.lo = {left - 1, -10, -10}, .hi = {left + depth, 10, 10}}}};
    return setup;
}

/// Element updates a second over whole steps: the best of some samples, and the median.
Json bench_step(NamedBody named, int threads) {
    const std::size_t elements = named.body.elements.tets.size();
    Simulation simulation = must(Simulation::create(hold_left(std::move(named.body), threads)));
    const double step = simulation.time_step().used;
    simulation.advance(50 * step);
    Samples rates;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        Timer timer;
        double wall = 0;
        std::int64_t steps = 0;
        while (wall < sample_time) {
            steps += simulation.advance(20 * step).steps;
            wall += timer.lap();
        }
        rates.add(static_cast<double>(steps) * static_cast<double>(elements) / wall);
    }
    const double best = rates.percentile(1);
    return {{"mesh", named.name},
            {"elements", elements},
            {"threads", threads},
            {"updates_per_s", {{"best", best}, {"median", rates.percentile(0.5)}}},
            {"step_us", 1e6 * static_cast<double>(elements) / best},
            {"real_time_factor", step * best / static_cast<double>(elements)}};
}

std::vector<NamedBody> bench_bodies() {
    std::vector<NamedBody> bodies;
    bodies.push_back({"block 6k", must(make_block({0.1, 0.1, 0.1}, {10, 10, 10}))});
    bodies.push_back({"block 50k", must(make_block({0.1, 0.1, 0.105}, {20, 20, 21}))});
    bodies.push_back({"liver 6097", must(make_liver({.elements = 6097}))});
    return bodies;
}

} // namespace

int bench(const BenchOptions& options) {
    for (const std::string& name : options.names) {
        if (name != "step" && name != "cut" && name != "matrix" && name != "fuzz") {
            return refuse(fmt::format("bench: '{}' is not known; give step, cut, matrix or fuzz", name));
        }
    }
    const auto named = [&](const char* name) {
        return std::find(options.names.begin(), options.names.end(), name) != options.names.end();
    };
    const auto wanted = [&](const char* name) { return options.names.empty() || named(name); };
    Json json;
    json["resect_version"] = version;
    json["isa"] = instruction_set();
    const bool talk = options.json != "-";
    if (wanted("step")) {
        for (NamedBody& body : bench_bodies()) {
            const Json row = bench_step(std::move(body), options.threads == 0 ? 1 : options.threads);
            if (talk) {
                fmt::print(
                    "step  {:10} {:6.1f} M element updates/s, {:8.1f} us a step, {:6.1f} times real time\n",
                    row["mesh"].get<std::string>(), 1e-6 * row["updates_per_s"]["best"].get<double>(),
                    row["step_us"].get<double>(), row["real_time_factor"].get<double>());
            }
            json["step"].push_back(row);
        }
    }
    if (wanted("cut")) { json["cut"] = bench_cut(talk); }
    if (named("matrix")) { json["matrix"] = bench_matrix(options.seeds, std::max(options.threads, 1), talk); }
    long failures = 0;
    if (named("fuzz")) { json["fuzz"] = bench_fuzz(options, talk, failures); }
    const int status = failures == 0 ? done : failed;
    if (options.json.empty()) { return status; }
    const Result<void> written = write_text(options.json, json.dump(2) + "\n");
    return written ? status : refuse(written.error().message);
}

} // namespace cli
