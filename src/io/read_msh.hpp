// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "resect/body.hpp"

namespace resect {

/// Gmsh 2.2 or 4.1, ASCII. Physical groups of points, curves and surfaces become node sets. Throws Refused.
Body read_msh(std::string_view text, const std::string& name);

} // namespace resect
