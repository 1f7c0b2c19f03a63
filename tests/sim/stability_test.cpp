// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <doctest/doctest.h>

#include "bodies.hpp"
#include "sim/engine.hpp"

using namespace resect;

namespace {

/// A block that hangs from one side; `load` is rho g L / E.
Setup hanging_block(double load) {
    Setup setup = held_block(4, 1000 * 9.81 * 0.1 / load);
    setup.gravity = {0, 0, -9.81};
    setup.damping = 2;
    return setup;
}

/// One that has been cut while it swung, so that copies have left the trusted range.
Simulation make_torn() {
    Simulation simulation = must(Simulation::create(hanging_block(0.4)));
    must(simulation.apply(MoveBlade{.to = edge_above(0.045, 0.11)}));
    must(simulation.apply(MoveBlade{.to = edge_above(0.045, -0.1)}));
    simulation.advance(0.7);
    must(simulation.apply(LiftBlade{}));
    return simulation;
}

Index count_weak(const Engine& engine) {
    return static_cast<Index>(std::count(engine.weak.begin(), engine.weak.end(), 1));
}

double total(const Energies& energies) {
    return energies.kinetic + energies.elastic + energies.gravity + energies.damped;
}

bool mentions(const std::vector<std::string>& warnings, const char* words) {
    return std::any_of(warnings.begin(), warnings.end(), [words](const std::string& warning) {
        return warning.find(words) != std::string::npos;
    });
}

} // namespace

TEST_CASE("copies that left the trusted range stay marked, through cuts and snapshots") {
    Simulation simulation = make_torn();
    Engine& engine = engine_of(simulation);
    CHECK(count_weak(engine) > 0);
    CHECK(simulation.strain().elements_weakened > 0);
    CHECK(simulation.strain().elements_weakened <= count_weak(engine));
    REQUIRE(engine.weak.size() == simulation.copies().node.size());

    Simulation other = must(Simulation::create(hanging_block(0.4)));
    must(other.restore(must(Snapshot::from_bytes(simulation.snapshot().bytes()))));
    CHECK(engine_of(other).weak == engine.weak);
    simulation.advance(0.2);
    other.advance(0.2);
    CHECK(other.hash() == simulation.hash());
    CHECK(other.strain().elements_weakened == simulation.strain().elements_weakened);

    const std::vector<std::uint8_t> before = engine.weak;
    const std::uint64_t hash = simulation.hash();
    must(simulation.cut(edge_above(0.03, 0.15), edge_above(0.03, -0.3)));
    REQUIRE(engine.weak.size() == simulation.copies().node.size());
    CHECK(engine.weak.size() > before.size());
    CHECK(std::equal(before.begin(), before.end(), engine.weak.begin()));
    must(simulation.apply(Undo{}));
    CHECK(simulation.hash() == hash);
    CHECK(engine.weak == before);
}

TEST_CASE("moduli are a matter of the nodes' masses and of the past alone") {
    Simulation simulation = make_torn();
    Engine& engine = engine_of(simulation);
    Index raised = 0;
    std::vector<Moduli> present;
    for (Index copy = 0; copy < engine.elements.count; ++copy) {
        present.push_back(moduli_of(engine.elements, copy));
        raised += present.back().wall > Moduli{}.wall ? 1 : 0;
        if (simulation_mesh(*engine.cutter).copy_weight[row(copy)] == 1 && engine.weak[row(copy)] == 0) {
            CHECK(present.back().mu == double(float(moduli(engine.tissue.materials[0]).mu)));
            CHECK(present.back().wall == Moduli{}.wall);
        }
    }
    CHECK(raised > 0);
    update_all_stiffness(engine);
    for (Index copy = 0; copy < engine.elements.count; ++copy) {
        const Moduli now = moduli_of(engine.elements, copy);
        CHECK(now.mu == present[row(copy)].mu);
        CHECK(now.bulk == present[row(copy)].bulk);
        CHECK(now.wall == present[row(copy)].wall);
    }
}

TEST_CASE("weakening takes energy, and the accounts tell where it went") {
    Simulation simulation = make_torn();
    const double start = total(simulation.energies());
    double damped = simulation.energies().damped;
    for (int i = 0; i < 10; ++i) {
        simulation.advance(0.1);
        CHECK(simulation.energies().damped >= damped);
        damped = simulation.energies().damped;
    }
    CHECK(simulation.strain().elements_weakened > 0);
    CHECK(total(simulation.energies()) == doctest::Approx(start).epsilon(1e-3 * damped));
}

TEST_CASE("whole elements keep their law, wherever they have been") {
    Simulation simulation = must(Simulation::create(hanging_block(0.4)));
    simulation.advance(1);
    CHECK(simulation.strain().elements_beyond_range > 0);
    CHECK(simulation.strain().elements_weakened == 0);
    CHECK(count_weak(engine_of(simulation)) == 0);
}

TEST_CASE("what goes beyond the method is told in words with the number") {
    Simulation light = must(Simulation::create(hanging_block(0.05)));
    CHECK(light.warnings().empty());
    must(light.apply(SetGravity{{0, 0, -6 * 9.81}})); // what counts is the gravity of now
    CHECK(mentions(light.warnings(), "load number rho g L / E is 0.30"));
    const Simulation heavy = must(Simulation::create(hanging_block(0.43)));
    REQUIRE(heavy.warnings().size() == 1);
    CHECK(mentions(heavy.warnings(), "load number rho g L / E is 0.43"));

    Setup fallen = hanging_block(0.43);
    fallen.fixed.clear();
    CHECK(must(Simulation::create(fallen)).warnings().empty());

    Setup mirrored = hanging_block(0.05);
    for (const Vec3& node : mirrored.body.elements.nodes) {
        mirrored.initial.displacement.push_back({0, 0, -2 * node[2]});
    }
    const Simulation inverted = must(Simulation::create(mirrored));
    CHECK(mentions(inverted.warnings(), "384 of 384 element copies were inside out"));
}

TEST_CASE("elements of a lattice weigh a share at least, and the body what its material does") {
    const Body body = must(make_liver({.elements = 1500}));
    double volume = 0;
    for (const auto& tet : body.material.tets) {
        volume += signed_volume(body.material, tet);
    }
    Setup setup{.body = body, .materials = {{.young = 2e4}}, .gravity = {}, .threads = 1};
    Simulation simulation = must(Simulation::create(setup));
    const SimulationMesh& mesh = simulation_mesh(*engine_of(simulation).cutter);
    double least_fraction = 1;
    std::vector<double> weight(body.elements.tets.size(), 0);
    for (std::size_t copy = 0; copy < mesh.copy_weight.size(); ++copy) {
        least_fraction = std::min(least_fraction, mesh.copy_fraction[copy]);
        weight[row(mesh.copy_element[copy])] += mesh.copy_weight[copy];
    }
    CHECK(least_fraction < 0.01);
    CHECK(*std::min_element(weight.begin(), weight.end()) == doctest::Approx(0.2).epsilon(1e-12));
    CHECK(*std::max_element(weight.begin(), weight.end()) < 1);
    CHECK(total_mass(simulation) == doctest::Approx(1000 * volume).epsilon(1e-6));
}
