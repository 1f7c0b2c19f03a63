// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "resect/body.hpp"

namespace resect {

/// A VTK XML unstructured grid, not compressed. One-component UInt8 point arrays become node sets: a point is
/// in the set where the array is not zero. Throws Refused.
Body read_vtu(std::string_view bytes, const std::string& name);

/// A point array of three components of a .vtu file.
Result<std::vector<Vec3>> read_vtu_vectors(const std::string& path, const std::string& array);

} // namespace resect
