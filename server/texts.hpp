// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "message.hpp"

namespace server {

/// A scene that pages can choose.
struct SceneEntry {
    std::string name = {}; // that of its file
    std::string title = {}, description = {};
    std::string path = {};
};

/// What `status` says beside what the simulation itself knows.
struct Figures {
    bool paused = false, diverged = false;
    std::string reason = {};
    double speed = 1, pace = 0; // simulated s in a s: asked for, reached
    double real_time_factor = 0;
    double step_rate = 0;           // steps in a s
    double tick_ms = 0, cut_us = 0; // longest since the last status
    double surface_us = 0;
    resect::Index cut_elements = 0;
    std::size_t clients = 0;
};

/// What `scene` says.
struct SceneFacts {
    std::uint32_t number = 0;
    std::string name = {}, title = {};
    resect::Index elements = 0;
    std::vector<resect::Material> materials = {};
    resect::Vec3 gravity = {};
    resect::Box bounds = {};
    double speed = 1;
    std::vector<std::string> notes = {};
};

/// Texts to pages (docs/protocol.md, "From the engine, texts").
std::string hello_text(bool driving, std::span<const SceneEntry> scenes);
std::string driving_text(bool driving, std::size_t clients);
std::string loading_text(const std::string& title);
std::string scene_text(const SceneFacts& facts);
std::string status_text(resect::Simulation& simulation, const Figures& figures);
std::string refused_text(resect::Index id, const std::string& message);
std::string notice_text(const std::string& message);
std::string hash_text(resect::Index id, const resect::Simulation& simulation);
std::string saved_text(resect::Index id, const std::string& path, const std::string& file);

} // namespace server
