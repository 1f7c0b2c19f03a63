// SPDX-License-Identifier: Apache-2.0
#include "bench_cut.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "resect/resect.hpp"

#include "samples.hpp"

namespace cli {

namespace {

using namespace resect;
using Json = nlohmann::ordered_json;

constexpr int replays = 5;
constexpr double blade_speed = 0.1; // m/s

/// What one increment of a stroke cost, the least over replays, and what it did.
struct Increment {
    CutTimes us = {};
    Index copies = 0;
};

struct Stroke {
    Edge from = {}, to = {};
};

/// One increment a step, while the tissue moves.
std::vector<Increment> cut_slowly(const Setup& setup, const Stroke& stroke, std::uint64_t& hash) {
    Simulation simulation = must(Simulation::create(setup));
    must(simulation.apply(MoveBlade{.to = stroke.from}));
    const double step = simulation.time_step().used;
    const Vec3 way = {stroke.to.tip[0] - stroke.from.tip[0], stroke.to.tip[1] - stroke.from.tip[1],
                      stroke.to.tip[2] - stroke.from.tip[2]};
    const double seconds = std::hypot(way[0], way[1], way[2]) / blade_speed;
    const int count = static_cast<int>(std::ceil(seconds / step));
    std::vector<Increment> increments;
    for (int i = 1; i <= count; ++i) {
        const double t = static_cast<double>(i) / count;
        Edge pose;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            pose.heel[axis] = (1 - t) * stroke.from.heel[axis] + t * stroke.to.heel[axis];
            pose.tip[axis] = (1 - t) * stroke.from.tip[axis] + t * stroke.to.tip[axis];
        }
        must(simulation.apply(MoveBlade{.to = pose}));
        const StepReport report = simulation.advance(step);
        increments.push_back({report.cut.us, report.cut.copies_added});
    }
    hash = simulation.hash();
    return increments;
}

/// Each increment's time is the least over replays that end in the same bits.
std::vector<Increment> replay_slowly(const Setup& setup, const Stroke& stroke, bool& same) {
    std::uint64_t first_hash = 0;
    std::vector<Increment> best = cut_slowly(setup, stroke, first_hash);
    same = true;
    for (int replay = 1; replay < replays; ++replay) {
        std::uint64_t hash = 0;
        const std::vector<Increment> again = cut_slowly(setup, stroke, hash);
        same = same && hash == first_hash && again.size() == best.size();
        for (std::size_t i = 0; i < std::min(best.size(), again.size()); ++i) {
            if (again[i].us.total() < best[i].us.total()) { best[i] = again[i]; }
        }
    }
    return best;
}

/// Of topology and copying, without detection, which is there whether a blade cuts or not.
double per_copy(const Increment& increment) {
    return (increment.us.total() - increment.us.detect) / increment.copies;
}

Json summary(const std::vector<Increment>& increments) {
    Samples all, copying;
    Index copies = 0;
    int slow = 0;
    double sum = 0;
    CutTimes us;
    for (const Increment& increment : increments) {
        all.add(increment.us.total());
        slow += increment.us.total() > 100 ? 1 : 0;
        copies += increment.copies;
        sum += increment.us.total() - increment.us.detect;
        us.detect += increment.us.detect;
        us.bisect += increment.us.bisect;
        us.tear += increment.us.tear;
        us.derive += increment.us.derive;
        us.check += increment.us.check;
        us.quantities += increment.us.quantities;
        if (increment.copies > 0) { copying.add(per_copy(increment)); }
    }
    return {{"increments", increments.size()},
            {"copies_added", copies},
            {"us_per_copy", {{"median", copying.percentile(0.5)}, {"mean", copies > 0 ? sum / copies : 0.0}}},
            {"us_per_increment",
             {{"p50", all.percentile(0.5)},
              {"p99", all.percentile(0.99)},
              {"p999", all.percentile(0.999)},
              {"max", all.percentile(1)}}},
            {"us",
             {{"detect", us.detect},
              {"bisect", us.bisect},
              {"tear", us.tear},
              {"derive", us.derive},
              {"check", us.check},
              {"quantities", us.quantities}}},
            {"share_under_100_us", 1 - static_cast<double>(slow) / static_cast<double>(increments.size())}};
}

Json bench_increments() {
    Setup setup{.body = must(make_liver({.elements = 6097, .refine = 0})), .damping = 2, .threads = 1};
    setup.fixed = {{.box = {.lo = {-1, -1, -1}, .hi = {-0.04, 1, 1}}}};
    const Stroke down{{{0.012, 0.12, 0.08}, {0.004, -0.12, 0.08}},
                      {{0.012, 0.12, -0.12}, {0.004, -0.12, -0.12}}};
    bool same = false;
    Json row = summary(replay_slowly(setup, down, same));
    row["mesh"] = "liver 6097";
    row["replays_with_the_same_bits"] = same;
    return row;
}

/// One stroke in a corner of blocks of the same cells, of which the larger has many more.
Json bench_size() {
    Json rows = Json::array();
    for (const Index cells : {10, 26}) {
        const double size = 0.01 * cells;
        Setup setup{
            .body = must(make_block({size, size, size}, {cells, cells, cells})), .gravity = {}, .threads = 1};
        const Stroke across{{{0.043, -0.01, 0.052}, {0.043, 0.08, 0.052}},
                            {{0.093, -0.01, 0.056}, {0.093, 0.08, 0.056}}};
        bool same = false;
        Json row = summary(replay_slowly(setup, across, same));
        row["mesh"] = fmt::format("block {}", 6 * cells * cells * cells);
        row["replays_with_the_same_bits"] = same;
        rows.push_back(row);
    }
    return rows;
}

/// A plane through a block of `cells` squared columns in one call.
CutReport cut_at_once(Index cells, Quantities quantities) {
    const double cell = 0.1 / cells;
    Setup setup{.body = must(make_block({4 * cell, 0.1, 0.1}, {4, cells, cells})), .threads = 1};
    setup.cut.quantities = quantities;
    Simulation simulation = must(Simulation::create(std::move(setup)));
    const double x = 1.47 * cell;
    return must(simulation.cut({{x, -0.02, 0.11}, {x + 0.1 * cell, 0.12, 0.11}},
                               {{x, -0.02, -0.01}, {x + 0.1 * cell, 0.12, -0.01}}));
}

void print_increments(const Json& row) {
    const Json& increment = row["us_per_increment"];
    fmt::print("cut   {:12} {:5} increments, {:4} copies: {:5.2f} us a copy (median), an increment {:.1f} us "
               "(p50), {:.1f} (p99.9), {:.1f} (max)\n",
               row["mesh"].get<std::string>(), row["increments"].get<int>(), row["copies_added"].get<int>(),
               row["us_per_copy"]["median"].get<double>(), increment["p50"].get<double>(),
               increment["p999"].get<double>(), increment["max"].get<double>());
}

} // namespace

Json bench_at_once(bool quick) {
    Json rows = Json::array();
    const std::pair<const char*, Quantities> ways[] = {{"copy", Quantities::copy},
                                                       {"recompute", Quantities::recompute},
                                                       {"recompute_all", Quantities::recompute_all}};
    const std::vector<Index> sizes =
        quick ? std::vector<Index>{4, 6} : std::vector<Index>{4, 6, 8, 10, 13, 16, 18};
    for (const Index cells : sizes) {
        std::array<CutReport, 3> best; // of each way, which take turns: the machine is not alike all the time
        for (int replay = 0; replay < 2 * replays; ++replay) {
            for (std::size_t way = 0; way < best.size(); ++way) {
                const CutReport cut = cut_at_once(cells, ways[way].second);
                if (replay == 0 || cut.us.total() < best[way].us.total()) { best[way] = cut; }
            }
        }
        for (std::size_t way = 0; way < best.size(); ++way) {
            const CutReport& cut = best[way];
            rows.push_back({{"elements_cut", cut.elements_cut},
                            {"copies_added", cut.copies_added},
                            {"quantities", ways[way].first},
                            {"total_us", cut.us.total()},
                            {"detect_us", cut.us.detect},
                            {"topology_us", cut.us.total() - cut.us.detect - cut.us.quantities},
                            {"quantities_us", cut.us.quantities}});
        }
    }
    return rows;
}

Json bench_cut(bool talk) {
    Json json;
    json["increments"] = bench_increments();
    if (talk) { print_increments(json["increments"]); }
    json["same_stroke"] = bench_size();
    for (const Json& row : json["same_stroke"]) {
        if (talk) { print_increments(row); }
    }
    json["at_once"] = bench_at_once();
    for (const Json& row : json["at_once"]) {
        if (!talk) { break; }
        fmt::print("cut   at once      {:5} elements, {:13}: {:8.0f} us, of these {:7.0f} topology, {:7.1f} "
                   "quantities\n",
                   row["elements_cut"].get<int>(), row["quantities"].get<std::string>(),
                   row["total_us"].get<double>(), row["topology_us"].get<double>(),
                   row["quantities_us"].get<double>());
    }
    return json;
}

} // namespace cli
