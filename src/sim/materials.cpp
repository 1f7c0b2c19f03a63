// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "fem/law.hpp"
#include "sim/check_setup.hpp"
#include "sim/engine.hpp"

namespace resect {

namespace {

/// With SF = step / bound and theta = viscous time / bound, the step is stable at rest while SF^2 + 2 theta
/// SF <= 1 (docs/method.md); the automatic one keeps the margin that 0.6 has at theta = 0.1.
Result<double> choose_time_step(const Model& model, const Tissue& tissue) {
    const double theta =
        *std::max_element(tissue.viscous_time.begin(), tissue.viscous_time.end()) / tissue.rest_bound;
    const auto largest = [theta](double sum) { return std::sqrt(theta * theta + sum) - theta; };
    if (model.asked_time_step == 0) {
        const double kept = safety_factor * safety_factor + 2 * viscous_share * safety_factor;
        return std::min(safety_factor, largest(kept)) * tissue.rest_bound;
    }
    const double stable = largest(1) * tissue.rest_bound;
    if (model.asked_time_step > stable && !model.allow_unstable_step) {
        return Error{
            fmt::format("time_step {:g} s is above {:g} s, the largest that is stable at rest (bound {:g} s, "
                        "viscosity counted); lower it, leave it 0, or set allow_unstable_step",
                        model.asked_time_step, stable, tissue.rest_bound)};
    }
    return model.asked_time_step;
}

Result<void> check_change(const Engine& engine, const SetMaterial& set) {
    const std::vector<Material>& present = engine.tissue.materials;
    if (set.region < 0 || row(set.region) >= present.size()) {
        return Error{fmt::format("set_material: region {} is not one of the {} that the body has", set.region,
                                 present.size())};
    }
    if (Result<void> checked = check_material(set.material, row(set.region)); !checked) { return checked; }
    const double density = present[row(set.region)].density;
    if (set.material.density != density) {
        return Error{
            fmt::format("set_material: density is {:g} for good, since masses are made with the body; "
                        "give that",
                        density)};
    }
    return {};
}

/// Of all copies: the law's moduli and the viscous time.
void set_tissue_of_copies(Engine& engine) {
    const SimulationMesh& mesh = simulation_mesh(*engine.cutter);
    for (Index copy = 0; copy < engine.elements.count; ++copy) {
        const std::size_t region = row(engine.model.region[row(mesh.copy_element[row(copy)])]);
        set_moduli(engine.elements, copy, moduli(engine.tissue.materials[region]));
        engine.elements.blocks[row(copy / lanes)].viscous_time[copy % lanes] =
            static_cast<float>(engine.tissue.viscous_time[region]);
    }
    engine.packing = build_packing(engine.elements, engine.nodes);
    update_all_stiffness(engine);
}

} // namespace

double least_step_bound(const Model& model, std::span<const Material> materials) {
    double bound = std::numeric_limits<double>::infinity();
    for (std::size_t element = 0; element < model.rest.size(); ++element) {
        bound = std::min(bound, rest_step_bound(model.rest[element], materials[row(model.region[element])]));
    }
    return bound;
}

Result<Tissue> make_tissue(const Model& model, std::vector<Material> materials) {
    Tissue tissue;
    tissue.materials = std::move(materials);
    tissue.rest_bound = least_step_bound(model, tissue.materials);
    for (const Material& material : tissue.materials) {
        const bool chosen = material.viscous_time != automatic;
        tissue.viscous_time.push_back(chosen ? material.viscous_time : viscous_share * tissue.rest_bound);
    }
    const Result<double> time_step = choose_time_step(model, tissue);
    if (!time_step) { return time_step.error(); }
    tissue.time_step = *time_step;
    return tissue;
}

Result<void> change_material(Engine& engine, const SetMaterial& set) {
    if (Result<void> checked = check_change(engine, set); !checked) { return checked; }
    std::vector<Material> materials = engine.tissue.materials;
    materials[row(set.region)] = set.material;
    Result<Tissue> tissue = make_tissue(engine.model, std::move(materials));
    if (!tissue) { return Error{"set_material: " + tissue.error().message}; }

    engine.clock_before += static_cast<double>(engine.step - engine.clock_start) * engine.tissue.time_step;
    engine.clock_start = engine.step;
    engine.tissue = std::move(*tissue);
    engine.constants.time_step = static_cast<float>(engine.tissue.time_step);
    engine.tissue.load_per_gravity = measure_load_per_gravity(engine);
    set_tissue_of_copies(engine);
    check_strain_now(engine);
    return {};
}

} // namespace resect
