// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "resect/simulation.hpp"

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "cut/cutter.hpp"
#include "fem/elements.hpp"
#include "fem/step.hpp"

namespace resect {

/// Steps between two looks at the strain (stretches, inversion, live bound).
inline constexpr std::int64_t check_interval = 50;

/// A blade on its way: poses that the next steps have yet to sweep, in order.
struct BladeWay {
    Index blade = 0;
    std::vector<Edge> poses = {};
};

/// What is prescribed by the user, by row of Body::elements.nodes.
struct Conditions {
    std::map<Index, Vec3> load = {};       // N
    std::map<Index, Vec3> prescribed = {}; // displacement, m
};

/// Work that left the motion, J.
struct Work {
    double internal = 0; // taken by the internal forces, elastic and viscous together
    double damping = 0;  // by mass-proportional damping
    double settling = 0; // by settle's resets of the velocity
};

/// Constant after creation.
struct Model {
    TetMesh elements = {};
    std::vector<RestElement> rest = {};  // [element]
    std::vector<Material> materials = {};
    std::vector<Index> region = {};      // [element] row of materials
    std::vector<double> viscous_time = {}; // [material] s
    double rest_bound = 0;               // s
    double size = 0;                     // diagonal of the rest box, m
    Weights weights = Weights::fraction;
};

struct Simulation::Impl {
    Model model = {};
    CutterPtr cutter = {};
    Conditions conditions = {};
    Elements elements = {};
    NodeArrays nodes = {};
    StepConstants constants = {};
    double time_step = 0; // s
    Workers workers;

    std::int64_t step = 0;       // since creation
    std::int64_t time_origin = 0; // step at which the clock started
    double carried = 0;          // seconds asked for and not yet stepped
    std::vector<BladeWay> blades = {}; // by blade id
    std::vector<Recorded> record = {};
    Work work = {};
    double elastic_start = 0; // J, of the initial motion
    double kinetic = 0;       // J, at the last half step
    Strain strain = {};
    double live_bound = 0; // s
    Delta delta = {};      // scratch of a sweep

    explicit Impl(int threads) : workers(threads) {}
};

/// One step of the motion; false: it diverged, and the state is the one before.
bool step_motion(Simulation::Impl& sim);
} // namespace resect
