// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "options.hpp"
#include "progress.hpp"
#include "samples.hpp"

namespace cli {

using namespace resect;

namespace {

int compare(const ReplayOptions& options, const Record& record, std::uint64_t hash) {
    if (hash == record.hash) {
        fmt::print("  hash     {:016x}, as recorded\n", hash);
        return done;
    }
    fmt::print("  hash     {:016x}; {:016x} was recorded\n", hash, record.hash);
    if (!options.check_hash) { return done; }
    fmt::print(
        stderr,
        "resect: {}: ended in another state than was recorded; replay with the version that wrote it\n",
        options.record);
    return failed;
}

} // namespace

int replay(const ReplayOptions& options) {
    const Result<Record> record = load_record(options.record);
    if (!record) { return refuse(record.error().message); }
    Result<Scene> scene = load_scene(record->scene, record->overrides);
    if (!scene) { return refuse(scene.error().message); }
    scene->setup.threads = options.threads;
    Result<Simulation> simulation = Simulation::create(std::move(scene->setup));
    if (!simulation) { return refuse(fmt::format("{}: {}", record->scene, simulation.error().message)); }

    Progress progress;
    progress.show(fmt::format("{}: replaying", scene->name));
    if (scene->settle) { simulation->settle(scene->settling.residual, scene->settling.at_most); }
    Timer timer;
    const Result<void> replayed = simulation->replay(record->commands, record->steps);
    const double wall = timer.lap();
    progress.clear();
    if (!replayed) {
        fmt::print(stderr, "resect: {}: {}\n", options.record, replayed.error().message);
        return failed;
    }
    const std::size_t pieces = simulation->pieces().size();
    fmt::print("{}: {} commands, {:.2f} simulated s in {:.2f} s; {} piece{}\n", scene->name,
               record->commands.size(), simulation->time(), wall, pieces, pieces == 1 ? "" : "s");
    if (!options.surface.empty()) {
        const Result<void> written = write_surface(options.surface, simulation->surface());
        if (!written) { return refuse(written.error().message); }
    }
    return compare(options, *record, simulation->hash());
}

} // namespace cli
