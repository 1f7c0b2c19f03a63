// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/engine.hpp"

namespace resect {

struct SnapshotState {
    std::uint64_t model = 0; // hash of what it belongs to
    SavedEngine saved = {};
    std::vector<Recorded> record = {};
};

/// Of what a simulation and a snapshot must have in common, from a simulation that has just been made.
std::uint64_t hash_model(const Engine& engine);
SnapshotState take_snapshot(const Engine& engine);
Result<void> restore_snapshot(Engine& engine, const SnapshotState& snapshot);

} // namespace resect
