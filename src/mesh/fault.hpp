// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "resect/result.hpp"

namespace resect {

/// Why a step of the way was refused, or nothing. Functions that give one write their last argument.
using Fault = std::optional<Error>;

} // namespace resect
