// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fmt/format.h>
#include <optional>

#include "options.hpp"
#include "output_folder.hpp"
#include "progress.hpp"
#include "report.hpp"

namespace cli {

namespace {

using namespace resect;

void print_summary(const Scene& scene, const InitialFigures& initial, SceneRun& run,
                   const RunOptions& options) {
    const RunFigures& figures = run.figures();
    Simulation& simulation = run.simulation();
    const TimeStep step = simulation.time_step();
    fmt::print("{}: {} elements, {:.2f} simulated s in {:.2f} s ({:.1f} times real time)\n", scene.name,
               initial.elements, figures.simulated, figures.wall, real_time_factor(figures));
    fmt::print("  cut      {} elements, {:.1f} cm^2; {} piece{}, open by {:.1f} mm\n",
               figures.cut.elements_cut, 1e4 * figures.cut.area, simulation.pieces().size(),
               simulation.pieces().size() == 1 ? "" : "s", 1e3 * find_opening(simulation.surface()));
    fmt::print("  step     {:.3f} ms; bound at rest {:.3f} ms, now {:.3f} ms\n", 1e3 * step.used,
               1e3 * step.bound, 1e3 * step.live_bound);
    if (figures.cut.refused > 0) {
        fmt::print("  refused  {} sweeps: {}\n", figures.cut.refused, figures.cut.reason);
    }
    for (const std::string& warning : simulation.warnings()) {
        fmt::print("  warning  {}\n", warning);
    }
    if (!options.out.empty()) {
        const std::string out = std::filesystem::relative(options.out).string();
        fmt::print(
            "  open     {0}/simulation.pvd and {0}/surface.pvd in ParaView, {0}/surface.obj anywhere, or\n"
            "           ./run picture {0}/surface.vtp -o {0}/surface.png\n",
            out);
    }
}

double seconds_of(const RunOptions& options, const Scene& scene) {
    return options.seconds >= 0 ? options.seconds : scene.duration;
}

/// What the scene does, with its files; an error where one could not be written.
Result<void> simulate(const Scene& scene, const RunOptions& options, SceneRun& run, OutputFolder* folder) {
    Progress progress;
    progress.show(fmt::format("{}: settling", scene.name));
    run.settle();
    const double seconds = seconds_of(options, scene);
    Result<void> written;
    // Without a folder a look only feeds the progress line.
    const double every = folder != nullptr ? scene.output_every : 1.0 / 60;
    if (run.figures().status == Status::diverged) {
        return folder != nullptr ? folder->add_frame(0, run.simulation()) : written;
    }
    run.run(seconds, every, [&](double time) {
        progress.show(
            fmt::format("{}: {:.2f} of {:.2f} s, {} copies, {} elements cut, {:.1f} times real time",
                        scene.name, time, seconds, run.simulation().copies().node.size(),
                        run.figures().cut.elements_cut, real_time_factor(run.figures())));
        if (folder != nullptr && written) { written = folder->add_frame(time, run.simulation()); }
    });
    return written;
}

} // namespace

int run(const RunOptions& options) {
    Result<Scene> scene = load_scene(options.scene, options.overrides);
    if (!scene) { return refuse(scene.error().message); }
    scene->setup.threads = options.threads;
    const InitialFigures initial = measure_initial(scene->setup.body, scene->setup.materials);
    std::optional<OutputFolder> folder;
    if (!options.out.empty()) {
        Result<OutputFolder> made = OutputFolder::make(options.out);
        if (!made) { return refuse(made.error().message); }
        folder = std::move(*made);
    }
    Result<Simulation> simulation = Simulation::create(std::move(scene->setup));
    if (!simulation) { return refuse(fmt::format("{}: {}", options.scene, simulation.error().message)); }

    SceneRun run(*scene, std::move(*simulation));
    if (const Result<void> checked = run.check(seconds_of(options, *scene)); !checked) {
        return refuse(fmt::format("{}: {}", options.scene, checked.error().message));
    }
    Result<void> written = simulate(*scene, options, run, folder ? &*folder : nullptr);
    if (written && folder) { written = folder->finish(run.simulation()); }
    if (!written) { return refuse(written.error().message); }

    if (!options.record.empty()) {
        written = write_record(options.record, options.scene, options.overrides, run.simulation());
    }
    const std::string json = report_json(options.scene, options.threads, initial, run);
    if (folder) { written = write_text(folder->path("report.json"), json); }
    if (written && !options.json.empty()) { written = write_text(options.json, json); }
    if (!written) { return refuse(written.error().message); }
    if (options.json != "-") { print_summary(*scene, initial, run, options); }
    if (run.figures().status == Status::ok) { return done; }
    fmt::print(stderr, "resect: {}: {}\n", options.scene, run.figures().reason);
    return failed;
}

} // namespace cli
