// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "texts.hpp"

namespace server {

/// The scene that is played, and its simulation.
class LiveScene {
public:
    /// Loads, makes and settles it. Blades that the scene itself moves are left out.
    static resect::Result<LiveScene> start(const SceneEntry& entry, int threads);

    const SceneEntry& entry() const { return entry_; }
    const SceneFacts& facts() const { return facts_; }
    resect::Simulation& simulation() { return simulation_; }
    /// Of the scenes played, so that pages know a new one.
    void number(std::uint32_t number) { facts_.number = number; }

    resect::Result<void> apply(const resect::Command& command);
    /// Lifts all blades and lets go of all grasps: nobody is there to do it.
    void let_go();
    /// A record, or a surface or mesh by the ending of `path`, as far as the simulation is now.
    resect::Result<void> save(const std::string& path);

private:
    LiveScene(SceneEntry entry, resect::Simulation simulation)
        : entry_(std::move(entry)), simulation_(std::move(simulation)) {}

    SceneEntry entry_;
    SceneFacts facts_ = {};
    resect::Simulation simulation_;
    std::set<Index> blades_ = {}, grasps_ = {};
};

/// The scenes in a folder, by name.
std::vector<SceneEntry> list_scenes(const std::string& folder);

/// Writes an upload and a scene around it into `folder`: the body stands on what it has lowest, and is as
/// stiff as it must be for that.
resect::Result<SceneEntry> write_scene_of(const Upload& upload, const std::string& folder);

} // namespace server
