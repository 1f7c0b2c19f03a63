// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/report.hpp"

namespace lab {

/// Whether the mechanics of a cut body are right: openings against conforming meshes, energy and momentum
/// through a cut, the step's bound over many cuts.
Section judge_cut_state(bool quick);

} // namespace lab
