// SPDX-License-Identifier: Apache-2.0
// The engine's float step, on the topology that cuts left, against the textbook in double precision.
#include <doctest/doctest.h>
#include <random>

#include "bodies.hpp"
#include "fem/law.hpp"
#include "fem/reference.hpp"
#include "sim/engine.hpp"

using namespace resect;

namespace {

/// Parallel slits from above, about an element deep: nothing comes free.
void cut_slits(Simulation& simulation, int count) {
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> place(0.02, 0.08), depth(0.02, 0.045);
    for (int slit = 0; slit < count; ++slit) {
        const double x = place(engine), y = place(engine), tip = 0.1 - depth(engine);
        must(simulation.cut({{x - 0.012, y, 0.13}, {x - 0.012, y, tip}},
                            {{x + 0.012, y, 0.13}, {x + 0.012, y, tip}}));
    }
}

ReferenceBody make_reference(Simulation& simulation, const Setup& setup) {
    const Nodes nodes = simulation.nodes();
    const SimulationMesh& mesh = simulation_mesh(*engine_of(simulation).cutter);
    ReferenceBody reference;
    const Moduli m = moduli(setup.materials.front());
    reference.mu = m.mu;
    reference.bulk = m.bulk;
    reference.viscous_time = engine_of(simulation).tissue.viscous_time.front();
    reference.damping = setup.damping;
    reference.gravity = setup.gravity;
    for (std::size_t node = 0; node < nodes.rest.size(); ++node) {
        reference.mesh.nodes.push_back(setup.body.elements.nodes[row(nodes.reference[node])]);
        reference.mass.push_back(mesh.node_mass[node]);
        reference.held.push_back(nodes.fixed[node] != 0);
        reference.u.push_back(to_double(nodes.displacement[node]));
        reference.v.push_back(to_double(nodes.velocity[node]));
    }
    for (std::size_t copy = 0; copy < mesh.copy_node.size(); ++copy) {
        reference.mesh.tets.push_back(mesh.copy_node[copy]);
        reference.weight.push_back(mesh.copy_weight[copy]);
    }
    return reference;
}

} // namespace

TEST_CASE("10,000 damped steps after 50 cuts agree with the textbook in double precision") {
    Setup setup = held_block(5, 4e4);
    setup.gravity = {0, 0, -9.81};
    setup.damping = 4;
    Simulation simulation = must(Simulation::create(setup));
    cut_slits(simulation, 50);
    REQUIRE(simulation.pieces().size() == 1);
    REQUIRE(simulation.copies().node.size() > setup.body.elements.tets.size() + 300);
    ReferenceBody reference = make_reference(simulation, setup);

    const double dt = double(engine_of(simulation).constants.time_step);
    const int steps = 10000;
    CHECK(simulation.advance(steps * simulation.time_step().used).steps == steps);
    for (int i = 0; i < steps; ++i) {
        reference_step(reference, dt);
    }
    CHECK(simulation.strain().elements_beyond_range == 0);
    double largest = 0, error = 0;
    for (std::size_t node = 0; node < reference.u.size(); ++node) {
        largest = std::max(largest, length(reference.u[node]));
        error = std::max(error, length(to_double(simulation.nodes().displacement[node]) - reference.u[node]));
    }
    MESSAGE("largest displacement ", largest, " m, relative error ", error / largest);
    CHECK(largest > 0.005);
    CHECK(error < 1e-5 * largest);

    const Engine& engine = engine_of(simulation);
    Vec3 sum = {};
    double total = 0;
    for (Index node = 0; row(node) < reference.u.size(); ++node) {
        const Vec3 force = to_double(internal_force(engine.packing, node));
        sum += force;
        total += length(force);
    }
    MESSAGE("sum of the internal forces over that of their magnitudes ", length(sum) / total);
    CHECK(length(sum) < 1e-7 * total);
}
