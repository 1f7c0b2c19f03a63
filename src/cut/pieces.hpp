// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cut/cutter_state.hpp"

namespace resect {

/// Finds the components of the material of a new cutter.
void label_pieces(Cutter& cutter);

/// Brings the pieces up to date after an increment: those of the tets in scratch.torn may have fallen apart.
/// Floods start on the sides of the tears that no node joins and take turns, so that the work is that of the
/// smaller side, or, where the tissue still holds, of going around the front.
void split_pieces(Cutter& cutter);

} // namespace resect
