// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "resect/body.hpp"

namespace resect {

/// The tets and node sets of a mesh file by its ending, as they stand there: finite coordinates and rows in
/// range, but not yet validated.
Result<Body> read_mesh_file(const std::string& path);

} // namespace resect
