// SPDX-License-Identifier: Apache-2.0
#include "cut/saved_state.hpp"

#include <algorithm>

#include "cut/transaction.hpp"

namespace resect {
namespace {

template <class Archive>
void archive_blade(Archive& archive, Blade& blade) {
    archive.value(blade.placed);
    archive.value(blade.stroke);
    archive.value(blade.frame);
    archive.value(blade.travel);
    archive.value(blade.step);
    archive.rows(blade.waiting);
    blade.pending.archive(archive);
    blade.sheet.archive(archive);
}

template <class Archive>
void archive_state(Archive& archive, CutterState& state) {
    each_rows(state, [&](auto& rows) { rows.archive(archive); });
    archive_each(archive, state.blades, [&](Blade& blade) { archive_blade(archive, blade); });
    archive.value(state.strokes);
    archive.value(state.revision);
}

} // namespace

std::shared_ptr<const CutterState> save_state(const Cutter& cutter) {
    auto state = std::make_shared<CutterState>(cutter);
    for (Blade& blade : state->blades) {
        blade.approach = {};
    }
    return state;
}

void restore_state(Cutter& cutter, const CutterState& saved) {
    const std::uint64_t revision = std::max(cutter.revision, saved.revision) + 1; // nobody has seen this one
    static_cast<CutterState&>(cutter) = saved;
    cutter.revision = revision;
    cutter.surface = {};
    forget_places(cutter);
}

std::size_t bytes_of(const CutterState& saved) {
    const MaterialMesh& material = saved.material;
    return material.tets.size() * sizeof(MaterialTet) + 150 * material.rest.size() +
           150 * saved.mesh.copy_node.size() + 60 * saved.mesh.node_mass.size();
}

void write_state(ByteWriter& writer, const CutterState& saved) {
    CutterState state = saved;
    archive_state(writer, state);
}

std::shared_ptr<const CutterState> read_state(ByteReader& reader) {
    auto state = std::make_shared<CutterState>();
    archive_state(reader, *state);
    return state;
}

} // namespace resect
