// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "mesh/validate.hpp"
#include "sim/check_setup.hpp"
#include "sim/engine.hpp"

namespace resect {

namespace {

constexpr Index homes_at_least = 12; // of a region that holds a lattice body

double rest_diagonal(const TetMesh& mesh) {
    Box box{mesh.nodes.front(), mesh.nodes.front()};
    for (const Vec3& node : mesh.nodes) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = std::min(box.lo[axis], node[axis]);
            box.hi[axis] = std::max(box.hi[axis], node[axis]);
        }
    }
    return length(box.hi - box.lo);
}

Model build_model(Setup& setup) {
    Model model;
    model.rest = build_rest(setup.body.elements);
    model.elements = setup.body.elements;
    model.materials = setup.materials;
    model.region = setup.body.region;
    model.region.resize(model.rest.size(), 0);
    model.loads = setup.loads;
    model.weights = setup.cut.weights;
    model.size = rest_diagonal(model.elements);
    model.rest_bound = std::numeric_limits<double>::infinity();
    double volume = 0;
    for (std::size_t element = 0; element < model.rest.size(); ++element) {
        const Material& material = model.materials[row(model.region[element])];
        model.rest_bound = std::min(model.rest_bound, rest_step_bound(model.rest[element], material));
        volume += model.rest[element].volume;
    }
    model.element_size = std::cbrt(volume / static_cast<double>(model.rest.size()));
    for (const Material& material : model.materials) {
        const bool chosen = material.viscous_time != automatic;
        model.viscous_time.push_back(chosen ? material.viscous_time : viscous_share * model.rest_bound);
    }
    return model;
}

/// With SF = step / bound and theta = viscous time / bound, the step is stable at rest while SF^2 + 2 theta
/// SF <= 1 (docs/method.md); the automatic one keeps the margin that 0.7 has at theta = 0.1.
Result<double> choose_time_step(const Setup& setup, const Model& model) {
    const double theta =
        *std::max_element(model.viscous_time.begin(), model.viscous_time.end()) / model.rest_bound;
    const auto largest = [theta](double sum) { return std::sqrt(theta * theta + sum) - theta; };
    if (setup.time_step == 0) {
        const double kept = safety_factor * safety_factor + 2 * viscous_share * safety_factor;
        return std::min(safety_factor, largest(kept)) * model.rest_bound;
    }
    const double stable = largest(1) * model.rest_bound;
    if (setup.time_step > stable && !setup.allow_unstable_step) {
        return Error{
            fmt::format("time_step {:g} s is above {:g} s, the largest that is stable at rest (bound {:g} s, "
                        "viscosity counted); lower it, leave it 0, or set allow_unstable_step",
                        setup.time_step, stable, model.rest_bound)};
    }
    return setup.time_step;
}

std::vector<HeldRegion> mark_held(const Setup& setup) {
    const double thicker = setup.body.lattice_spacing / 4;
    std::vector<HeldRegion> held;
    for (const Fixed& fixed : setup.fixed) {
        HeldRegion region;
        region.box = {fixed.box.lo - Vec3{thicker, thicker, thicker},
                      fixed.box.hi + Vec3{thicker, thicker, thicker}};
        if (!fixed.node_set.empty()) {
            region.node_marked.assign(setup.body.elements.nodes.size(), 0);
            for (const Index node : setup.body.node_sets.at(fixed.node_set)) {
                region.node_marked[row(node)] = 1;
            }
        }
        held.push_back(std::move(region));
    }
    return held;
}

/// A hold on next to nothing would let the body pivot: better refused than simulated.
Result<void> check_holds(const Setup& setup, std::span<const HeldRegion> held, const SimulationMesh& mesh) {
    const bool lattice = setup.body.lattice_spacing > 0;
    for (std::size_t at = 0; at < held.size(); ++at) {
        Index homes = 0;
        for (std::size_t node = 0; node < mesh.node_home.size(); ++node) {
            const std::vector<std::uint8_t>& marked = held[at].node_marked;
            const bool inside = marked.empty() ? is_inside(held[at].box, mesh.node_home[node])
                                               : marked[row(mesh.node_reference[node])] != 0;
            homes += inside ? 1 : 0;
        }
        if (homes < (lattice ? homes_at_least : 1)) {
            return Error{
                fmt::format("fixed {}: holds {} nodes, too few to hold the body; make its region larger, or "
                            "the elements smaller",
                            at, homes)};
        }
    }
    return {};
}

void build_nodes(Engine& engine, const Motion& initial) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    NodeArrays& nodes = engine.nodes;
    const std::size_t count = mesh.node_reference.size();
    const auto start = [&](const std::vector<Vec3>& values, std::size_t node) {
        return values.empty() ? Vec3f{} : to_float(values[row(mesh.node_reference[node])]);
    };
    for (std::size_t node = 0; node < count; ++node) {
        nodes.rest.push_back(to_float(engine.model.elements.nodes[row(mesh.node_reference[node])]));
        nodes.displacement.push_back(start(initial.displacement, node));
        nodes.velocity.push_back(start(initial.velocity, node));
    }
    nodes.next_displacement.resize(count);
    nodes.next_velocity.resize(count);
    nodes.load.resize(count);
    nodes.mass.resize(count);
    nodes.inverse_mass.resize(count);
    engine.swept = nodes.displacement;
    update_all_conditions(engine);
}

void build_elements(Engine& engine) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    const Model& model = engine.model;
    for (std::size_t copy = 0; copy < mesh.copy_node.size(); ++copy) {
        const std::size_t element = row(mesh.copy_element[copy]), region = row(model.region[element]);
        append_copy(engine.elements, model.rest[element], model.materials[region],
                    {.viscous_time = model.viscous_time[region],
                     .weight = mesh.copy_weight[copy],
                     .nodes = mesh.copy_node[copy]});
        engine.copy_density.push_back(static_cast<float>(model.materials[region].density));
    }
    link_corners(engine.elements, static_cast<Index>(mesh.node_reference.size()));
}

} // namespace

Result<std::unique_ptr<Engine>> build_engine(Setup setup) {
    Result<std::vector<std::string>> notes = mend_and_validate(setup.body.elements);
    if (!notes) { return notes.error(); }
    if (const Result<void> checked = check_setup(setup); !checked) { return checked.error(); }

    auto engine = std::make_unique<Engine>(setup.threads);
    engine->model = build_model(setup);
    const Model& model = engine->model;
    Result<double> time_step = choose_time_step(setup, model);
    if (!time_step) { return time_step.error(); }
    engine->time_step = *time_step;
    engine->constants = {.time_step = static_cast<float>(*time_step),
                         .damping = static_cast<float>(setup.damping),
                         .gravity = to_float(setup.gravity)};

    CutterSetup cutting{.held = mark_held(setup), .options = setup.cut};
    for (std::size_t element = 0; element < model.rest.size(); ++element) {
        cutting.element_mass.push_back(model.materials[row(model.region[element])].density *
                                       model.rest[element].volume);
    }
    const std::vector<HeldRegion> held = cutting.held;
    Result<CutterPtr> cutter = make_cutter(setup.body, std::move(cutting));
    if (!cutter) { return cutter.error(); }
    engine->cutter = std::move(*cutter);
    if (const Result<void> checked = check_holds(setup, held, simulation_mesh(*engine->cutter)); !checked) {
        return checked.error();
    }
    build_elements(*engine);
    build_nodes(*engine, setup.initial);
    engine->elastic_start = elastic_energy(engine->elements, engine->nodes.displacement);
    for (std::size_t node = 0; node < engine->nodes.mass.size(); ++node) {
        const Vec3 v = to_double(engine->nodes.velocity[node]);
        engine->kinetic += static_cast<double>(engine->nodes.mass[node]) / 2 * dot(v, v);
    }
    check_strain_now(*engine);
    return engine;
}

} // namespace resect
