// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cut/cutter_state.hpp"

namespace resect {

/// From here on every change of the state is noted.
void open_state(CutterState& state);
/// Forgets the notes.
void close_state(CutterState& state);
/// Undoes every change since open_state.
void take_back_state(CutterState& state);

} // namespace resect
