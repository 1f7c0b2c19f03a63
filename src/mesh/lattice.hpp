// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/lattice_grid.hpp"

// A body as a lattice cut by its own boundary: the elements are all lattice tets that hold material, whole
// and of one shape; the material is what lies inside.
namespace resect {

/// Crossings of the boundary are kept this share of an edge away from its ends, so that no tiny tet arises;
/// few are so near once the surface is snapped to the vertices that it nearly meets.
inline constexpr double least_crossing = 0.05;

Fault build_lattice_body(const Shape& shape, const Box& bounds, const LatticePlan& plan, Body& body);

/// The number of elements that build_lattice_body makes, found faster; crumbs that it drops are counted.
Fault count_lattice_elements(const Shape& shape, const Box& bounds, const LatticePlan& plan, Index& count);

struct ElementTarget {
    Index elements = 0;
    Index tolerance = 0;
    int tries = 40;
};

struct FoundLattice {
    LatticePlan plan = {};
    Body body = {};
};

/// Tries spacings and offsets, always the same ones, until the number of elements fits.
Fault find_lattice_body(const Shape& shape, const Box& bounds, const ElementTarget& target, int refine,
                        FoundLattice& found);

/// What make_body refuses about how fine the body is to be.
Fault check_lattice(const Lattice& lattice);

} // namespace resect
