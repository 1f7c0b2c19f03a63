// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "resect/body.hpp"

namespace resect {

/// W = mu/2 (J^(-2/3) tr C - 3) + K/2 (J - 1)^2 with mu = E / (2 (1 + nu)), K = E / (3 (1 - 2 nu));
/// docs/method.md says how it goes on for crushed and inverted elements.
enum class Law { neo_hookean };

inline constexpr double automatic = -1;

struct Material {
    Law law = Law::neo_hookean;
    double young = 5000;   // Pa
    double poisson = 0.35; // below 0.5
    double density = 1000; // kg/m^3
    /// Time constant of the strain-rate viscosity, s; automatic: a tenth of the rest bound of the step; 0:
    /// none.
    double viscous_time = automatic;
};

/// Material that cannot move: what lies in the box, or carries the nodes of the set. On a lattice body the
/// box is thickened by a quarter of the lattice spacing (docs/method.md, "What is held").
struct Fixed {
    std::string node_set = {}; // a name of Body::node_sets; empty: the box
    Box box = {};
};

/// How an element's copies share its stiffness and mass once it is cut: by the material that each holds, or
/// as plain copies of the whole (the paper's rule, which adds mass).
enum class Weights { fraction, copy };

/// How the precomputed quantities of a new copy are had: copied from the cut element (the paper's method 1),
/// computed anew for the new copies (its method 2), or computed anew for the whole mesh. The motion is the
/// same to rounding.
enum class Quantities { copy, recompute, recompute_all };

/// What becomes of elements that a blade's tip ends in: `soft` cuts through those that it has passed for the
/// most part, so that shallow cuts open; `hold` leaves them whole.
enum class Front { soft, hold };

struct CutOptions {
    Weights weights = Weights::fraction;
    Quantities quantities = Quantities::copy;
    Front front = Front::soft;
    int refine = 0; // 0 to 2: halvings of the material's edges around a blade; elements stay as they are
    /// Check every invariant after every increment, not only what it touched; an increment that fails is
    /// refused either way.
    bool verify = false;
};

/// A start other than rest, [element node], m and m/s; empty: zero.
struct Motion {
    std::vector<Vec3> displacement = {}, velocity = {};
};

struct Setup {
    Body body = {};
    std::vector<Material> materials = {Material{}};
    std::vector<Fixed> fixed = {};
    std::vector<std::pair<Index, Vec3>> loads = {}; // element node, N
    Motion initial = {};
    Vec3 gravity = {0, 0, -9.81}; // m/s^2
    double damping = 0;           // alpha of D = alpha M, 1/s
    double time_step = 0;         // s; 0: 0.6 of the rest bound
    bool allow_unstable_step = false;
    CutOptions cut = {};
    int threads = 0; // 0: all cores; never changes a bit of the result
};

} // namespace resect
