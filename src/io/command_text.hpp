// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "resect/commands.hpp"

namespace resect {

/// {"move_blade": {"blade": 0, "heel": [x, y, z], "tip": [x, y, z]}}.
nlohmann::ordered_json json_of(const Command& command);

/// Throws Refused.
Command command_of(const nlohmann::ordered_json& value);

} // namespace resect
