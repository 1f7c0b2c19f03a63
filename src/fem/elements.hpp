// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "resect/setup.hpp"

#include "base/vec.hpp"
#include "fem/law.hpp"
#include "mesh/tet.hpp"

namespace resect {

inline constexpr Index lanes = 16;

/// The precomputed quantities of 16 element copies; copy c is lane c % 16 of block c / 16. All zero: no copy.
struct alignas(64) ElementBlock {
    Index node[4][lanes];         // rows of NodeArrays
    float gradient[3][3][lanes];  // 1/m, rest shape derivatives of corners 1, 2, 3 [corner - 1][axis]
    float volume[lanes];          // m^3, weight times rest volume
    float mu[lanes], bulk[lanes]; // Pa
    float wall[lanes];            // of bulk, see Moduli
    float viscous_time[lanes];    // s
};

/// The element copies, by number; the step works on the same in another order (fem/packing.hpp).
struct Elements {
    Index count = 0;
    std::vector<ElementBlock> blocks;
};

/// Rest data of an element, in double precision; never changes (paper III.C, pre-computation 1).
struct RestElement {
    std::array<Vec3, 4> gradient = {}; // 1/m, of the four shape functions
    double volume = 0;                 // m^3
};

RestElement build_rest_element(const TetMesh& mesh, const Tet& tet);
std::vector<RestElement> build_rest(const TetMesh& mesh);

/// Closed-form lower bound of the critical time step at rest, s: 1 / (c_p sqrt(sum 1 / h_i^2)).
double rest_step_bound(const RestElement& rest, const Material& material);

/// What a copy weighs, how it is damped and where it hangs.
struct CopyOptions {
    double viscous_time = 0; // s
    double weight = 1;
    Tet nodes = {}; // rows of NodeArrays
};

/// Appends a copy with everything precomputed for its element.
void append_copy(Elements& elements, const RestElement& rest, const Material& material,
                 const CopyOptions& options);
/// Computes everything of a copy anew.
void set_copy(Elements& elements, Index copy, const RestElement& rest, const Material& material,
              const CopyOptions& options);
/// Appends a copy of a copy: memory is copied, nothing is computed (the paper's method 1).
void append_copy_of(Elements& elements, Index parent);
/// `volume` is the rest volume of the whole element.
void set_weight(Elements& elements, Index copy, double weight, double volume);
/// What the law is told of a copy: its material's, but for what a caller made of it.
void set_moduli(Elements& elements, Index copy, const Moduli& moduli);
Moduli moduli_of(const Elements& elements, Index copy);
void set_corner(Elements& elements, Index copy, Index corner, Index node);
Tet corners(const Elements& elements, Index copy);

} // namespace resect
