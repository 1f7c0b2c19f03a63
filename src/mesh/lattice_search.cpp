// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

#include "mesh/lattice.hpp"

namespace resect {
namespace {

constexpr Index most_elements = 20'000'000;
/// Tries that find no material, each at half the spacing of the one before, until a body counts as empty.
constexpr int most_empty_tries = 5;

/// The lattice shift of a try: points that fill the unit cube evenly, however many are taken (powers of the
/// inverse of the root of x^4 = x + 1).
Vec3 offset_of_try(int number) {
    constexpr double root = 1.2207440846057596;
    const auto fraction = [&](double step) { return std::fmod(number * step, 1.0); };
    return {fraction(1 / root), fraction(1 / (root * root)), fraction(1 / (root * root * root))};
}

double volume_of(const Box& box) {
    const Vec3 size = box.hi - box.lo;
    return size[0] * size[1] * size[2];
}

/// The spacing at which a body would have `elements`, from the number that it has at `spacing`: numbers go
/// with volumes, so this errs by the share of the boundary only.
double scale_spacing(double spacing, Index found, Index elements) {
    if (found == 0) { return spacing / 2; }
    return spacing * std::cbrt(static_cast<double>(found) / elements);
}

Fault check_shape(const Shape& shape, const Box& bounds) {
    if (!shape) { return Error{"the body has no function: give one that is negative inside"}; }
    const Vec3 size = bounds.hi - bounds.lo;
    if (is_finite(size) && *std::min_element(size.begin(), size.end()) > 0) { return {}; }
    return Error{
        fmt::format("bounds from ({}) to ({}) m hold nothing: hi must be above lo on each axis, both finite",
                    fmt::join(bounds.lo, ", "), fmt::join(bounds.hi, ", "))};
}

} // namespace

Fault check_lattice(const Lattice& lattice) {
    const auto& [elements, spacing, refine] = lattice;
    if (elements < 0 || elements > most_elements) {
        return Error{fmt::format("lattice elements {}: must lie in 1 to {}", elements, most_elements)};
    }
    if (!std::isfinite(spacing) || spacing < 0) {
        return Error{fmt::format("lattice spacing {} m: must be finite and above 0", spacing)};
    }
    if ((elements > 0) == (spacing > 0)) {
        return Error{fmt::format("lattice with elements {} and spacing {} m: give exactly one of the two",
                                 elements, spacing)};
    }
    if (refine < 0 || refine > 3) {
        return Error{fmt::format("lattice refine {}: must lie in 0 to 3", refine)};
    }
    return {};
}

Fault find_lattice_body(const Shape& shape, const Box& bounds, const ElementTarget& target, int refine,
                        FoundLattice& found) {
    // A first, cheap count finds how much of the bounds is filled.
    constexpr Index first_target = 1000;
    LatticePlan& plan = found.plan;
    plan = {std::cbrt(6 * volume_of(bounds) / std::min(target.elements, first_target)), {}, refine};
    const auto miss = [&](Index count) { return std::abs(count - target.elements); };
    Index nearest = 0;
    int empty_tries = 0;
    for (int number = 1; number <= target.tries; ++number) {
        plan.offset = offset_of_try(number);
        Index count = 0;
        if (Fault fault = count_lattice_elements(shape, bounds, plan, count)) { return fault; }
        if (miss(count) < miss(nearest)) { nearest = count; }
        if (miss(count) <= target.tolerance) {
            if (Fault fault = build_lattice_body(shape, bounds, plan, found.body)) { return fault; }
            if (miss(static_cast<Index>(found.body.elements.tets.size())) <= target.tolerance) { return {}; }
        }
        if (count == 0 && ++empty_tries == most_empty_tries) { break; }
        plan.spacing = scale_spacing(plan.spacing, count, target.elements);
    }
    return Error{fmt::format("no lattice with {} elements was found, the nearest has {}: the body is empty, "
                             "or the number too small for it; give a spacing",
                             target.elements, nearest)};
}

Result<Body> make_body(const std::function<double(Vec3)>& inside_below_zero, Box bounds, Lattice lattice) {
    FoundLattice found = {{lattice.spacing, {}, lattice.refine}, {}};
    Fault fault = check_shape(inside_below_zero, bounds);
    if (!fault) { fault = check_lattice(lattice); }
    if (!fault && lattice.spacing > 0) {
        fault = build_lattice_body(inside_below_zero, bounds, found.plan, found.body);
    } else if (!fault) {
        const ElementTarget target = {lattice.elements, lattice.elements / 100, 40};
        fault = find_lattice_body(inside_below_zero, bounds, target, lattice.refine, found);
    }
    if (fault) { return *fault; }
    return std::move(found.body);
}

} // namespace resect
