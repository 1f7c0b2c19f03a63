// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "cut/cutter_state.hpp"

namespace resect {

/// The least share of an element's weight that each of several copies has.
inline double weight_floor(Index count) { return count > 1 ? std::min(0.2, 0.5 / count) : 1; }

/// The least share of a whole element that the solver gives an element, however little material it holds.
inline constexpr double least_element_weight = 0.2;

/// Shares the weight of an element among its copies (docs/cutting.md, "Weights"): the share of material, with
/// a floor once there are several; in copy mode the whole of it for each.
void weigh_element(Cutter& cutter, Index element);

/// Mass of a node that is the class of `pairs`, kg.
double sum_mass(const Cutter& cutter, std::span<const Index> pairs);

} // namespace resect
