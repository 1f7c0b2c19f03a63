// SPDX-License-Identifier: Apache-2.0
#include "lab_paper.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "bench_cut.hpp"
#include "scene_run.hpp"

namespace cli {

namespace {

using namespace resect;

constexpr double frame = 1.0 / 60; // s

/// What was seen of a scene, frame by frame.
struct SceneFilm {
    std::vector<double> time = {}, frame_ms = {}, step_us = {}, opening_mm = {}, elements = {};
    std::vector<bool> is_cutting = {};
    std::vector<lab::Still> stills = {};
    Index pieces = 0, elements_before = 0;
};

Result<SceneFilm> film_scene(const std::string& path, const std::vector<double>& stills,
                             std::span<const std::string> overrides) {
    Result<Scene> scene = load_scene(path, overrides);
    if (!scene) { return scene.error(); }
    scene->setup.threads = 1;
    Result<Simulation> made = Simulation::create(scene->setup);
    if (!made) { return made.error(); }
    SceneRun run(*scene, std::move(*made));
    run.settle();
    SceneFilm film{.elements_before = static_cast<Index>(run.simulation().copies().node.size())};
    std::size_t next_still = 0;
    std::size_t step_count = 0;
    double step_sum = 0; // us
    run.run(scene->duration, frame, [&](double time) {
        Simulation& simulation = run.simulation();
        const RunFigures& figures = run.figures();
        if (figures.frame_ms.count() > film.frame_ms.size()) {
            const auto elements = static_cast<double>(simulation.copies().node.size());
            film.is_cutting.push_back(!film.elements.empty() && elements > film.elements.back());
            film.time.push_back(time);
            film.frame_ms.push_back(figures.frame_ms.last());
            film.step_us.push_back((figures.step_us.sum() - step_sum) /
                                   static_cast<double>(figures.step_us.count() - step_count));
            step_sum = figures.step_us.sum();
            step_count = figures.step_us.count();
            film.elements.push_back(elements);
            film.opening_mm.push_back(1e3 * find_opening(simulation.surface()));
        }
        if (next_still < stills.size() && time >= stills[next_still] - frame / 2) {
            film.stills.push_back({fmt::format("{:.2f} s", time), lab::surface_of(simulation)});
            ++next_still;
        }
        film.pieces = static_cast<Index>(simulation.pieces().size());
    });
    return film;
}

/// Of the frames in which elements were cut.
lab::Series pick_cutting(const SceneFilm& film, const std::vector<double>& values) {
    lab::Series series{.name = "frames with a cut", .points = true};
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!film.is_cutting[i]) { continue; }
        series.x.push_back(film.time[i]);
        series.y.push_back(values[i]);
    }
    return series;
}

lab::Plot plot_frames(const SceneFilm& film) {
    const double slowest = *std::max_element(film.frame_ms.begin(), film.frame_ms.end());
    return {
        .name = "liver_frames",
        .title = "Scene 3: computing time of every frame",
        .says = fmt::format(
            "All {} frames of a sixtieth of a second are counted, steps, cuts and surface included, on one "
            "thread: the slowest takes {:.1f} ms. The paper's rate of 40 Hz, its least, allows 25 ms.",
            film.time.size(), slowest),
        .x_label = "time, s",
        .y_label = "computing time of a frame, ms",
        .log_y = true,
        .series = {{"all frames", film.time, film.frame_ms},
                   pick_cutting(film, film.frame_ms),
                   {"the paper's 40 Hz", {film.time.front(), film.time.back()}, {25, 25}},
                   {"real time, 60 Hz", {film.time.front(), film.time.back()}, {1000.0 / 60, 1000.0 / 60}}}};
}

} // namespace

Result<lab::Section> reproduce_cuboid(const std::string& scenes, bool quick) {
    const std::vector<std::string> coarse = {"tissue.mesh.block.cells=[6,4,4]", "duration=0.7"};
    const Result<SceneFilm> film =
        film_scene(scenes + "/cuboid.json", {0, 0.25, 0.45, 0.7, 1.5},
                   quick ? std::span<const std::string>(coarse) : std::span<const std::string>());
    if (!film) { return film.error(); }
    lab::Strip strip{.name = "cuboid",
                     .title = "Figure 3: a cuboid is cut while it bends",
                     .says = "The block bends from the start; the knife, a line without force, goes in from "
                             "above, and the incision grows open as the block goes on sagging.",
                     .stills = film->stills,
                     .camera = {{0.18, -0.32, 0.13}, {0.042, 0.03, 0.0}, 22}};
    lab::Plot plot{
        .name = "cuboid_opening",
        .title = "Scene 1: opening of the incision",
        .says = fmt::format(
            "The widest distance between the two sides: it opens behind the knife, to {:.1f} mm at "
            "the most, swings with the block, and is {:.1f} mm at the end.",
            *std::max_element(film->opening_mm.begin(), film->opening_mm.end()), film->opening_mm.back()),
        .x_label = "time, s",
        .y_label = "opening, mm",
        .series = {{"opening", film->time, film->opening_mm}}};
    return lab::Section{
        .title = "Scene 1: the cuboid",
        .text = {"scenes/cuboid.json: 8 x 6 x 6 cm, E = 5 kPa, nu = 0.35 as in the paper; size, density and "
                 "damping, which it does not give, are in the scene's description."},
        .parts = {std::move(strip), std::move(plot)}};
}

lab::Section reproduce_cutting_cost(bool quick) {
    lab::Plot total{.name = "figure_4",
                    .title = "Figure 4: time for cutting many elements at once",
                    .x_label = "elements cut at once",
                    .y_label = "time, ms",
                    .log_x = true,
                    .log_y = true};
    lab::Plot parts = total;
    parts.name = "figure_4_quantities";
    parts.title = "Figure 4, the precomputed quantities alone";
    const std::pair<const char*, const char*> ways[] = {
        {"copy", "method 1: copied"},
        {"recompute", "method 2: computed anew for new elements"},
        {"recompute_all", "method 2, all elements anew"}};
    const nlohmann::ordered_json rows = bench_at_once(quick);
    lab::Series topology{.name = "topology alone"};
    for (const auto& [key, name] : ways) {
        lab::Series whole{.name = name};
        lab::Series quantities{.name = name};
        for (const auto& row : rows) {
            if (row["quantities"] != key) { continue; }
            whole.x.push_back(row["elements_cut"]);
            whole.y.push_back(1e-3 * row["total_us"].get<double>());
            quantities.x.push_back(row["elements_cut"]);
            quantities.y.push_back(1e-3 * row["quantities_us"].get<double>());
            if (whole.name == ways[0].second) {
                topology.x.push_back(row["elements_cut"]);
                topology.y.push_back(1e-3 * row["topology_us"].get<double>());
            }
        }
        total.series.push_back(std::move(whole));
        parts.series.push_back(std::move(quantities));
    }
    const auto last = [](const lab::Series& series) { return series.y.back(); };
    total.series.push_back(std::move(topology));
    total.says =
        fmt::format("With {:.0f} elements at once, copying takes {:.2f} of the time of computing the new "
                    "elements anew, and {:.2f} of computing all anew: today the topology takes most of it.",
                    total.series[0].x.back(), last(total.series[0]) / last(total.series[1]),
                    last(total.series[0]) / last(total.series[2]));
    parts.says = fmt::format(
        "Of the quantities alone, copying takes {:.1f} times less than computing anew: a tet's gradients are "
        "some fifty nanoseconds' work now, so the gain that the paper shows is real and small.",
        last(parts.series[1]) / last(parts.series[0]));
    return {.title = "Scene 2: what a cut costs",
            .text = {"A plane cuts a whole layer of a block in one go. Method 1 copies the precomputed "
                     "quantities of the cut element, method 2 computes them anew, once for the new elements "
                     "and once for all; topology is the same. The least of ten runs each."},
            .parts = {std::move(total), std::move(parts)}};
}

Result<lab::Section> reproduce_liver(const std::string& scenes, bool quick) {
    const std::vector<std::string> coarse = {"tissue.mesh.liver.elements=1200", "tissue.mesh.liver.refine=0"};
    const Result<SceneFilm> film =
        film_scene(scenes + "/liver.json", {0, 0.45, 0.65, 0.75, 0.9},
                   quick ? std::span<const std::string>(coarse) : std::span<const std::string>());
    if (!film) { return film.error(); }
    lab::Strip strip{.name = "liver",
                     .title = "Figure 5: a liver is cut, sags and comes apart",
                     .says = fmt::format("The liver has settled under its weight; the knife goes through "
                                         "beside the held lobe, and the cut part sags. {} pieces at the end.",
                                         film->pieces),
                     .stills = film->stills,
                     .camera = {{0.1, -0.85, 0.06}, {0.02, 0, -0.05}, 26}};
    lab::Plot elements{.name = "liver_elements",
                       .title = "Scene 3: number of elements",
                       .says =
                           fmt::format("{} at first, {:.0f} at the end. Copies of elements are counted: one "
                                       "that holds two separate parts of the organ has two from the start.",
                                       film->elements_before, film->elements.back()),
                       .x_label = "time, s",
                       .y_label = "elements",
                       .series = {{"elements", film->time, film->elements}}};
    lab::Plot steps{.name = "liver_steps",
                    .title = "Scene 3: computing time of a step",
                    .says = fmt::format(
                        "Means over a frame, without the cuts themselves but with what follows them "
                        "(packing of the copies, checks) and with whatever else the machine does: "
                        "{:.0f} us at first, {:.0f} at the most.",
                        film->step_us.front(), *std::max_element(film->step_us.begin(), film->step_us.end())),
                    .x_label = "time, s",
                    .y_label = "computing time of a step, us",
                    .series = {{"step", film->time, film->step_us}}};
    return lab::Section{
        .title = "Scene 3: the liver",
        .text = {fmt::format("scenes/liver.json: {} tets, E = 5 kPa, nu = 0.35 as in the paper, one thread. "
                             "The paper holds \"some of left most nodes\"; here the heavy right lobe is "
                             "held, because a liver this soft cannot hang by its thin end.",
                             film->elements_before)},
        .parts = {std::move(strip), plot_frames(*film), std::move(elements), std::move(steps)}};
}

lab::Section list_paper_to_code() {
    lab::Table code{.name = "paper_to_code",
                    .title = "Equations, steps and figures",
                    .says = "Every part of the paper, and what does it here.",
                    .columns = {"paper", "what", "here"}};
    code.rows = {
        {"equation 1", "equation of motion, lumped mass, D = alpha M",
         "src/fem/node_update.cpp; tests/fem motion"},
        {"equation 2", "internal forces summed over elements", "src/fem/kernel_source.inc, fans and packing"},
        {"equation 3", "nodal forces from the second Piola-Kirchhoff stress",
         "src/fem/law.cpp, element_forces.cpp; tests/fem against a double textbook"},
        {"equations 4, 5", "strain-displacement matrix from precomputed shape derivatives",
         "never formed: F from the precomputed gradients, force = -V P dN/dX (docs/method.md)"},
        {"figure 1", "virtual node algorithm",
         "src/cut (docs/cutting.md); any number of copies, cuts anywhere"},
        {"figure 2", "TLED and virtual nodes together", "src/sim/blades.cpp, quantities.cpp"},
        {"precomputation 1, 2", "shape derivatives, volumes, masses; topology", "src/sim/create.cpp"},
        {"time stepping 1", "loop over elements", "src/sim/step.cpp: element forces"},
        {"time stepping 2", "loop over nodes, central differences", "src/sim/step.cpp: node update"},
        {"time stepping 3", "knife, topology, copying", "src/sim/blades.cpp, src/cut/cutter.cpp"},
        {"figure 3", "cuboid", "this report; resect run scenes/cuboid.json"},
        {"figure 4", "copying against computing anew", "this report; resect bench cut"},
        {"figure 5", "liver", "this report; resect run scenes/liver.json"},
        {"figure 6", "incisions of other methods", "this report, \"The rivals\""}};
    lab::Table values{.name = "values",
                      .title = "Values that the paper does not give",
                      .says = "Our choices, with why, are in the scenes' descriptions and in docs/method.md.",
                      .columns = {"what", "the paper", "here"}};
    values.rows = {
        {"density", "not given", "1000 kg/m^3"},
        {"damping alpha", "not given", "2 1/s (liver), 6 1/s (cuboid)"},
        {"time step", "not given", "0.6 of the rest bound"},
        {"bulk modulus", "from E and nu", "K = E / (3 (1 - 2 nu)), W as in include/resect/setup.hpp"},
        {"mass of the copies", "not said; copies of everything",
         "shares by material, mass kept (weights: copy is the paper's rule)"},
        {"a cut through a node or an edge", "not said", "exact integer decisions, docs/cutting.md"},
        {"the tip inside an element", "not said", "soft tip, theta = 0.25"},
        {"crushed and inverted elements", "not said", "the law is continued, docs/method.md"}};
    return {.title = "Paper to code", .text = {}, .parts = {std::move(code), std::move(values)}};
}

} // namespace cli
