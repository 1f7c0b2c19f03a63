// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/vec.hpp"

namespace resect::fuzz {

/// Points p with dot(normal, p - point) = 0.
struct Plane {
    Vec3 normal = {}, point = {};
};

/// The volumes of the cells into which planes part a box, smallest first: one for each sign vector that
/// points of the box have.
std::vector<double> compute_cells(const Box& box, std::span<const Plane> planes);

} // namespace resect::fuzz
