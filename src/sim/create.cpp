// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/reserve.hpp"
#include "mesh/validate.hpp"
#include "sim/check_setup.hpp"
#include "sim/engine.hpp"
#include "sim/snapshot.hpp"

namespace resect {

namespace {

constexpr std::size_t reserved = 3;  // times the rows at creation
constexpr Index homes_at_least = 12; // of a region that holds a lattice body

Model build_model(Setup& setup) {
    Model model;
    model.rest = build_rest(setup.body.elements);
    model.elements = setup.body.elements;
    model.region = setup.body.region;
    model.region.resize(model.rest.size(), 0);
    model.loads = setup.loads;
    model.weights = setup.cut.weights;
    model.quantities = setup.cut.quantities;
    const Box box = bounds_of(model.elements);
    model.size = length(box.hi - box.lo);
    model.asked_time_step = setup.time_step;
    model.allow_unstable_step = setup.allow_unstable_step;
    double volume = 0;
    for (const RestElement& rest : model.rest) {
        volume += rest.volume;
    }
    model.element_size = std::cbrt(volume / static_cast<double>(model.rest.size()));
    return model;
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
            const bool named = marked.empty() ? is_inside(held[at].box, mesh.node_home[node])
                                              : marked[row(mesh.node_reference[node])] != 0;
            homes += named && mesh.node_held[node] != 0 ? 1 : 0;
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

bool uses_node(const SimulationMesh& mesh, Index reference) {
    return std::find(mesh.node_reference.begin(), mesh.node_reference.end(), reference) !=
           mesh.node_reference.end();
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
    engine.classes.resize(engine.model.elements.nodes.size());
    for (std::size_t node = 0; node < count; ++node) {
        engine.classes[row(mesh.node_reference[node])].push_back(static_cast<Index>(node));
    }
    engine.swept = nodes.displacement;
    engine.packing = build_packing(engine.elements, nodes);
    update_all_conditions(engine);
}

void build_elements(Engine& engine) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    const Model& model = engine.model;
    for (std::size_t copy = 0; copy < mesh.copy_node.size(); ++copy) {
        const std::size_t element = row(mesh.copy_element[copy]), region = row(model.region[element]);
        append_copy(engine.elements, model.rest[element], engine.tissue.materials[region],
                    {.viscous_time = engine.tissue.viscous_time[region],
                     .weight = mesh.copy_weight[copy],
                     .nodes = mesh.copy_node[copy]});
        engine.copy_density.push_back(static_cast<float>(engine.tissue.materials[region].density));
        engine.weak.push_back(0);
    }
}

/// Room for what cuts add.
void reserve_rows(Engine& engine) {
    NodeArrays& nodes = engine.nodes;
    for (std::vector<Vec3f>* rows :
         {&nodes.rest, &nodes.displacement, &nodes.velocity, &nodes.next_displacement, &nodes.next_velocity,
          &nodes.load, &engine.swept}) {
        reserve_ahead(*rows, reserved);
    }
    reserve_ahead(nodes.mass, reserved);
    reserve_ahead(nodes.inverse_mass, reserved);
    reserve_ahead(engine.fixed, reserved);
    reserve_ahead(engine.copy_density, reserved);
    reserve_ahead(engine.weak, reserved);
    reserve_ahead(engine.elements.blocks, reserved);
    reserve_ahead(engine.packing.seats, reserved);
    reserve_ahead(engine.packing.first_slot, reserved);
}

} // namespace

Result<std::unique_ptr<Engine>> build_engine(Setup setup) {
    Result<std::vector<std::string>> notes = mend_and_validate(setup.body.elements);
    if (!notes) { return notes.error(); }
    if (const Result<void> checked = check_setup(setup); !checked) { return checked.error(); }

    auto engine = std::make_unique<Engine>(setup.threads);
    engine->model = build_model(setup);
    const Model& model = engine->model;
    Result<Tissue> tissue = make_tissue(model, setup.materials);
    if (!tissue) { return tissue.error(); }
    engine->tissue = std::move(*tissue);
    engine->constants = {.time_step = static_cast<float>(engine->tissue.time_step),
                         .damping = static_cast<float>(setup.damping),
                         .gravity = to_float(setup.gravity)};

    std::vector<float> viscous_time; // [element]
    CutterSetup cutting{.held = mark_held(setup), .options = setup.cut};
    for (std::size_t element = 0; element < model.rest.size(); ++element) {
        cutting.element_mass.push_back(setup.materials[row(model.region[element])].density *
                                       model.rest[element].volume);
        viscous_time.push_back(static_cast<float>(engine->tissue.viscous_time[row(model.region[element])]));
    }
    cutting.node_order = order_nodes(model.elements, viscous_time);
    const std::vector<HeldRegion> held = cutting.held;
    Result<CutterPtr> cutter = make_cutter(setup.body, std::move(cutting));
    if (!cutter) { return cutter.error(); }
    engine->cutter = std::move(*cutter);
    if (const Result<void> checked = check_holds(setup, held, simulation_mesh(*engine->cutter)); !checked) {
        return checked.error();
    }
    for (const auto& load : model.loads) {
        if (!uses_node(simulation_mesh(*engine->cutter), load.first)) {
            return Error{fmt::format("load: node {} belongs to no element; load another", load.first)};
        }
    }
    build_elements(*engine);
    build_nodes(*engine, setup.initial);
    engine->tissue.load_per_gravity = measure_load_per_gravity(*engine);
    update_all_stiffness(*engine);
    reserve_rows(*engine);
    engine->elastic_start = elastic_energy(engine->elements, engine->nodes.displacement);
    check_strain_now(*engine);
    engine->model.hash = hash_model(*engine);
    return engine;
}

} // namespace resect
