// SPDX-License-Identifier: Apache-2.0
#include "base/hash.hpp"

#include "cut/cutter_state.hpp"

namespace resect {

std::uint64_t hash_topology(const Cutter& cutter) {
    const SimulationMesh& mesh = cutter.mesh;
    const auto all = []<class T>(const Rows<T>& rows) { return rows.view(); };
    Hash hash;
    hash.add(all(mesh.copy_node))
        .add(all(mesh.copy_element))
        .add(all(mesh.copy_fraction))
        .add(all(mesh.copy_weight));
    hash.add(all(mesh.node_reference))
        .add(all(mesh.node_mass))
        .add(all(mesh.node_home))
        .add(all(mesh.node_held));
    for (const MaterialTet& tet : cutter.material.tets) {
        hash.add(tet.vertex).add(tet.link).add(tet.label).add(tet.copy).add(tet.volume);
    }
    return hash.add(all(cutter.material.rest)).value();
}

} // namespace resect
