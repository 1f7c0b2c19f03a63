// SPDX-License-Identifier: Apache-2.0
#include "bench_realtime.hpp"

#include <fmt/format.h>

#include "report.hpp"
#include "samples.hpp"

namespace cli {

namespace {

using namespace resect;
using Json = nlohmann::ordered_json;

constexpr double settle_time =
    0.5;                         // s; at most, and not to the end: what counts is the speed of a loaded body
constexpr double measured = 0.1; // s of simulated time a sample
constexpr int repeats = 5;

Json measure(Index elements, int threads) {
    Setup setup{.body = must(make_liver({.elements = elements})),

                .damping = 2,
                .threads = threads};
    setup.fixed = {{.box = {.lo = {-1, -1, -1}, .hi = {-0.04, 1, 1}}}};
    const std::size_t count = setup.body.elements.tets.size();
    Simulation simulation = must(Simulation::create(std::move(setup)));
    simulation.settle(1e-3, settle_time);
    Samples factors;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        Timer timer;
        simulation.advance(measured);
        factors.add(measured / timer.lap());
    }
    const TimeStep step = simulation.time_step();
    return {{"elements", count},
            {"threads", threads},
            {"step_s", step.used},
            {"step_over_bound", step.used / step.bound},
            {"real_time_factor", {{"best", factors.percentile(1)}, {"median", factors.percentile(0.5)}}}};
}

} // namespace

Json bench_realtime(int threads, bool talk) {
    Json rows = Json::array();
    double factor = 0;
    Index elements = 6097;
    do {
        const Json row = measure(elements, threads);
        factor = row["real_time_factor"]["best"].get<double>();
        if (talk) {
            fmt::print("realtime  liver {:7} elements, step {:.3g} ms ({:.2f} of the bound): {:6.2f} times "
                       "real time\n",
                       row["elements"].get<std::size_t>(), 1e3 * row["step_s"].get<double>(),
                       row["step_over_bound"].get<double>(), factor);
        }
        rows.push_back(row);
        elements = elements * 3 / 2;
    } while (factor >= 1);
    return rows;
}

} // namespace cli
