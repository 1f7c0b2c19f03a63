// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "resect/reports.hpp"

#include "base/vec.hpp"
#include "fem/elements.hpp"
#include "fem/packing.hpp"

namespace resect {

struct StepConstants {
    float time_step = 0; // s
    float damping = 0;   // alpha, 1/s
    Vec3f gravity = {};  // m/s^2
};

/// Sums over a range of nodes, in node order. Works are over the step from half a step before to half a step
/// after, at the mean of both velocities; for free nodes the change of kinetic energy is then the work of
/// gravity and loads less internal_work and damping_work, to rounding, whatever the step.
struct StepSums {
    double internal_work = 0; // J, that the internal forces took (elastic and viscous), held nodes included
    double damping_work = 0;  // J, that mass-proportional damping took
    float speed_squared = 0;  // largest along an axis, of free nodes; NaN if anything is not finite
};
StepSums operator+(const StepSums& a, const StepSums& b);

/// Deformation, stress and nodal forces of the copies of a part (paper III.A, equations 2 to 5), at the
/// positions that node_update and place_node left: x + viscous_time v, which adds strain-rate viscosity of
/// that time constant to first order.
void element_forces(const Elements& elements, const NodeArrays& nodes, Packing& packing, Index part);

/// Net forces and central differences for nodes [begin, end), begin a multiple of 8: paper III.C, time
/// stepping 2. Reads displacement and velocity, writes next_displacement, next_velocity and positions.
StepSums node_update(Packing& packing, NodeArrays& nodes, const StepConstants& constants, Range range);

/// What a node resists with, N, from the forces that element_forces left.
Vec3f internal_force(const Packing& packing, Index node);
/// Gravity and load on a node, N.
Vec3 applied_force(const NodeArrays& nodes, const StepConstants& constants, Index node);
/// Applied less internal force on a node, N.
Vec3 net_force(const Packing& packing, const NodeArrays& nodes, const StepConstants& constants, Index node);

/// Deformation of the copies, looked at every few steps.
struct StrainCheck {
    double stretch_min = 1, stretch_max = 1;
    Index beyond_range = 0, inverted = 0;                        // not is_trusted (fem/law.hpp), J <= 0
    Index worst_copy = -1;                                       // smallest live bound
    double live_bound = std::numeric_limits<double>::infinity(); // s
};
/// Of copies [begin, end); `density` is by copy, kg/m^3. Viscosity does not count.
StrainCheck check_strain(const Elements& elements, const NodeArrays& nodes, std::span<const float> density,
                         Range copies);
/// The same without bounds, and past copies whose stretches are certain to lie among those of `known`: a
/// small part of the time where few copies are deformed most. Copies begin at a multiple of `lanes`.
StrainCheck screen_strain(const Elements& elements, const NodeArrays& nodes, const StrainCheck& known,
                          Range copies);
/// Of both ranges; the earlier one's copy stays where bounds are equal.
StrainCheck merge(const StrainCheck& a, const StrainCheck& b);

double kinetic_energy(const NodeArrays& nodes);                                       // J, at the half step
double elastic_energy(const Elements& elements, std::span<const Vec3f> displacement); // J
/// Of one copy, J.
double elastic_energy(const Elements& elements, std::span<const Vec3f> displacement, Index copy);
double von_mises_stress(const Elements& elements, const NodeArrays& nodes, Index copy); // Pa, Cauchy

} // namespace resect
