// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/report.hpp"

namespace lab {

/// Methods that the paper argues against, beside its own and ours: one block, one knife; the liver; the sizes
/// of the paper's figure 6; what linear elasticity makes of a bend. Coarse bodies if `quick`.
Section compare_rivals(bool quick);

} // namespace lab
