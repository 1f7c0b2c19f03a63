// SPDX-License-Identifier: Apache-2.0
#include "sim/snapshot.hpp"

#include <fmt/format.h>

#include "resect/version.hpp"

#include "base/command_fields.hpp"
#include "base/hash.hpp"

namespace resect {

namespace {

/// Of what decides whether a state fits: elements, materials, step, options.
template <class Archive>
void archive_material(Archive& archive, Material& material) {
    archive.value(material.law);
    for (double* value : {&material.young, &material.poisson, &material.density, &material.viscous_time}) {
        archive.value(*value);
    }
}

template <class Archive, class T>
void archive_field(Archive& archive, T& value) {
    archive.value(value);
}
template <class Archive, class T>
void archive_field(Archive& archive, std::vector<T>& rows) {
    archive.rows(rows);
}

template <class Archive>
void archive_recorded(Archive& archive, Recorded& recorded) {
    archive.value(recorded.step);
    archive.value(recorded.until);
    std::uint64_t kind = recorded.command.index();
    archive.value(kind);
    if constexpr (Archive::reads) { recorded.command = make_command(kind); }
    std::visit(
        [&](auto& command) {
            each_field(command, [&](const char*, auto& value, Need) { archive_field(archive, value); });
        },
        recorded.command);
}

template <class Archive>
void archive_prescribed(Archive& archive, std::map<Index, Vec3>& prescribed) {
    std::vector<std::pair<Index, Vec3>> told(prescribed.begin(), prescribed.end());
    archive_each(archive, told, [&](std::pair<Index, Vec3>& one) {
        archive.value(one.first);
        archive.value(one.second);
    });
    prescribed = {told.begin(), told.end()};
}

template <class Archive>
void archive_nodes(Archive& archive, NodeArrays& nodes) {
    for (std::vector<Vec3f>* rows : {&nodes.rest, &nodes.displacement, &nodes.velocity,
                                     &nodes.next_displacement, &nodes.next_velocity, &nodes.load}) {
        archive.rows(*rows);
    }
    archive.rows(nodes.mass);
    archive.rows(nodes.inverse_mass);
}

template <class Archive>
void archive_elements(Archive& archive, Elements& elements) {
    archive.value(elements.count);
    archive.rows(elements.blocks);
}

template <class Archive>
void archive_packing(Archive& archive, Packing& packing) {
    archive_each(archive, packing.parts, [&](Part& part) {
        archive.value(part.viscous_time);
        archive.value(part.first_slot);
        archive.value(part.slots);
        archive.value(part.room);
        archive.rows(part.blocks);
        archive.rows(part.nodes);
        archive.rows(part.tets);
        archive.rows(part.copies);
        archive.rows(part.spare);
        archive_each(archive, part.cells, [&](Cell& cell) {
            archive.rows(cell.copies);
            archive.value(cell.moved);
            archive.value(cell.moved_before);
            archive.value(cell.quiet);
        });
        archive.rows(part.dropped);
    });
    archive.rows(packing.seats);
    archive.value(packing.quanta_a_metre);
    archive.rows(packing.rest);
    archive.rows(packing.position);
    archive.rows(packing.force);
    for (std::vector<Index>* rows :
         {&packing.slot_node, &packing.slot_part, &packing.first_slot, &packing.next_slot}) {
        archive.rows(*rows);
    }
    archive.value(packing.one_viscous_time);
}

template <class Archive>
void archive_tissue(Archive& archive, Tissue& tissue) {
    archive_each(archive, tissue.materials, [&](Material& material) { archive_material(archive, material); });
    archive.rows(tissue.viscous_time);
    archive.value(tissue.rest_bound);
    archive.value(tissue.time_step);
    archive.value(tissue.load_per_gravity);
}

template <class Archive>
void archive_state(Archive& archive, EngineState& state) {
    archive_elements(archive, state.elements);
    archive_packing(archive, state.packing);
    archive_nodes(archive, state.nodes);
    archive.value(state.constants);
    archive_prescribed(archive, state.prescribed);
    archive_each(archive, state.classes, [&](std::vector<Index>& nodes) { archive.rows(nodes); });
    archive_each(archive, state.blades, [&](BladeWay& way) {
        archive.value(way.blade);
        archive.value(way.at);
        archive.value(way.before);
        archive.rows(way.poses);
        archive.value(way.begun);
    });
    archive_each(archive, state.grasps, [&](GraspWay& way) {
        archive.value(way.grasp);
        archive.value(way.at);
        archive.value(way.to);
        archive.value(way.radius);
        archive_each(archive, way.nodes, [&](GraspedNode& grasped) {
            archive.value(grasped.node);
            archive.value(grasped.offset);
        });
    });
    archive.rows(state.swept);
    archive.value(state.step);
    archive.value(state.clock_start);
    archive.value(state.clock_before);
    archive_tissue(archive, state.tissue);
    archive.value(state.carried);
    archive.value(state.work);
    archive.value(state.elastic_start);
    archive.value(state.strain);
    archive.value(state.live_bound);
    archive.rows(state.fixed);
    archive.rows(state.copy_density);
    archive.rows(state.weak);
}

template <class Archive>
void archive_snapshot(Archive& archive, SnapshotState& snapshot) {
    archive.value(snapshot.model);
    archive_each(archive, snapshot.record, [&](Recorded& recorded) { archive_recorded(archive, recorded); });
    archive_state(archive, snapshot.saved.state);
}

/// What snapshots begin with; sizes tell builds apart that lay memory out differently.
std::string heading() {
    return fmt::format("Resect snapshot {} {} {}\n", version, sizeof(ElementBlock), sizeof(EngineState));
}

std::uint64_t hash_bytes(std::string_view bytes) { return Hash().add(std::span<const char>(bytes)).value(); }

} // namespace

std::uint64_t hash_model(const Engine& engine) {
    const Model& model = engine.model;
    Hash hash;
    hash.add(std::span<const Vec3>(model.elements.nodes)).add(std::span<const Tet>(model.elements.tets));
    hash.add(std::span<const Index>(model.region)).add(std::span<const double>(engine.tissue.viscous_time));
    for (const Material& material : engine.tissue.materials) {
        hash.add(material.young).add(material.poisson).add(material.density);
    }
    return hash.add(model.weights).add(engine.tissue.time_step).add(engine.constants.damping).value();
}

SnapshotState take_snapshot(const Engine& engine) {
    return {engine.model.hash, save_engine(engine), engine.record};
}

Result<void> restore_snapshot(Engine& engine, const SnapshotState& snapshot) {
    if (snapshot.model != engine.model.hash) {
        return Error{
            "restore: the snapshot is of another body, material or step; create the simulation from the "
            "setup that it was taken from"};
    }
    restore_engine(engine, snapshot.saved);
    engine.record = snapshot.record;
    engine.carried_out = engine.record.size();
    engine.strokes.clear();
    engine.between = {};
    return {};
}

std::string Snapshot::bytes() const {
    ByteWriter writer;
    if (!empty()) {
        SnapshotState copy = *state_;
        archive_snapshot(writer, copy);
        write_state(writer, *state_->saved.cutter);
    }
    const std::string content = writer.take();
    const std::uint64_t hash = hash_bytes(content);
    std::string all = heading();
    all.append(reinterpret_cast<const char*>(&hash), sizeof(hash));
    return all + content;
}

Result<Snapshot> Snapshot::from_bytes(std::string_view bytes) {
    const std::string expected = heading();
    if (!bytes.starts_with("Resect snapshot")) { return Error{"not a snapshot: it does not begin as one"}; }
    if (!bytes.starts_with(expected)) {
        return Error{fmt::format("a snapshot of another version than {}: take it anew", version)};
    }
    bytes.remove_prefix(expected.size());
    std::uint64_t hash = 0;
    if (bytes.size() < sizeof(hash)) { return Error{"a snapshot that was cut off: take it anew"}; }
    std::memcpy(&hash, bytes.data(), sizeof(hash));
    bytes.remove_prefix(sizeof(hash));
    if (hash != hash_bytes(bytes)) { return Error{"a snapshot that was damaged or cut off: take it anew"}; }
    if (bytes.empty()) { return Snapshot(); }
    auto state = std::make_shared<SnapshotState>();
    ByteReader reader(bytes);
    archive_snapshot(reader, *state);
    state->saved.cutter = read_state(reader);
    if (reader.failed()) { return Error{"a snapshot of another build: take it anew"}; }
    return Snapshot(std::move(state));
}

} // namespace resect
