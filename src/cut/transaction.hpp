// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cut/cutter_state.hpp"

namespace resect {

/// Calls visit for the rows of M, of S and of what hangs on them.
template <class Visit>
void each_rows(CutterState& state, Visit visit) {
    MaterialMesh& material = state.material;
    visit(material.tets);
    visit(material.rest);
    visit(material.support);
    visit(material.any_tet);
    visit(material.grain);
    visit(material.on_cut);
    SimulationMesh& mesh = state.mesh;
    visit(mesh.copy_node);
    visit(mesh.copy_element);
    visit(mesh.copy_fraction);
    visit(mesh.copy_weight);
    visit(mesh.node_reference);
    visit(mesh.node_mass);
    visit(mesh.node_home);
    visit(mesh.node_held);
    visit(state.first_tet);
    visit(state.sibling);
    visit(state.tet_count);
    visit(state.beside);
    visit(state.pieces.of_copy);
    visit(state.pieces.pieces);
}

/// From here on every change of the state is noted.
void open_state(CutterState& state);
/// Forgets the notes.
void close_state(CutterState& state);
/// Undoes every change since open_state.
void take_back_state(CutterState& state);

} // namespace resect
