// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "resect/body.hpp"

namespace resect {

/// A VTK legacy file, ASCII or binary. Throws Refused.
Body read_vtk(std::string_view bytes, const std::string& name);

} // namespace resect
