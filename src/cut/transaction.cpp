// SPDX-License-Identifier: Apache-2.0
#include "cut/transaction.hpp"

namespace resect {
namespace {

/// Calls visit for every container of rows that an increment changes.
template <class Visit>
void each_container(CutterState& state, Visit visit) {
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
    visit(state.pieces.of_copy);
    for (Blade& blade : state.blades) {
        if (!blade.placed) { continue; }
        visit(blade.pending);
        visit(blade.sheet);
    }
}

} // namespace

void open_state(CutterState& state) {
    each_container(state, [](auto& container) { container.open(); });
}

void close_state(CutterState& state) {
    each_container(state, [](auto& container) { container.close(); });
}

void take_back_state(CutterState& state) {
    each_container(state, [](auto& container) { container.take_back(); });
}

} // namespace resect
