// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace resect {

/// The candidate that takes the fewest typing mistakes to become `name` (the first of equals); empty where
/// none takes fewer than half of the letters.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

} // namespace resect
