// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "resect/body.hpp"

namespace resect {

/// An index as a row of an array.
constexpr std::size_t row(Index index) { return static_cast<std::size_t>(index); }

} // namespace resect
