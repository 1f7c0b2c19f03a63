// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cut/cutter_state.hpp"

namespace resect {

/// Finds the faces of elements that lie in a held region.
void mark_held_faces(Cutter& cutter);

/// Notes which elements have held nodes, before any cut; until then homes alone decide what is held, and held
/// faces.
void mark_held_elements(Cutter& cutter);

/// The home of a class of (copy, corner) pairs: the material vertex of its copies that is nearest to the
/// reference node.
Index find_home(const Cutter& cutter, std::span<const Index> pairs, Index reference);

/// Writes home and hold of a node.
void update_home(Cutter& cutter, Index node, std::span<const Index> pairs);

} // namespace resect
