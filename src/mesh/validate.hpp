// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "resect/body.hpp"
#include "resect/result.hpp"

namespace resect {

/// Turns a wholly inverted mesh; refuses what cannot be simulated, by name, row and value. Rows are kept. The
/// notes say what was mended and what is odd but harmless, one line each.
Result<std::vector<std::string>> mend_and_validate(TetMesh& mesh);

} // namespace resect
