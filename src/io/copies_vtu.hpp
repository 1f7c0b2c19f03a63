// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "resect/reports.hpp"

namespace resect {

/// The .vtu of the element copies: points at rest, and all fields as arrays.
std::string copies_vtu(const Nodes& nodes, const Copies& copies, std::span<const double> von_mises);

} // namespace resect
