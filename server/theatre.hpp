// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "inbox.hpp"
#include "live_scene.hpp"
#include "pacer.hpp"

namespace server {

struct TheatreOptions {
    std::vector<SceneEntry> scenes = {};
    SceneEntry first = {};
    int threads = 0;
    std::string folder = {}; // for what pages save and upload
};

/// Plays one scene after the other in real time, on one thread, for pages that come and go.
class Theatre {
public:
    Theatre(TheatreOptions options, Inbox& inbox, Send send);

    /// Starts the first scene.
    resect::Result<void> open() { return start(options_.first); }
    /// Plays, once open, until the inbox is closed.
    void run();

private:
    void handle(const Event& event);
    void hear(ClientId client, const Message& message);
    void answer(ClientId client, Index id, const Request& request);
    void tell(ClientId client, Index id, const resect::Command& command);
    void start(ClientId client, Index id, const SceneEntry& entry);
    resect::Result<void> start(const SceneEntry& entry);
    void save(ClientId client, Index id, const std::string& what);
    void refuse(ClientId client, Index id, const std::string& message);
    void advance(double seconds);
    void take_steps(Index steps);
    void take_step();
    bool is_running() const { return !paused_ && !figures_.diverged; }
    void publish(Clock::time_point now);

    TheatreOptions options_;
    Inbox& inbox_;
    Clients clients_;
    Pacer pacer_ = {};
    std::optional<LiveScene> scene_ = {};
    std::uint32_t scene_number_ = 0;
    Index last_message_ = 0; // of the driver
    bool paused_ = false;
    double speed_ = 1;
    Figures figures_ = {};
    Index split_at_start_ = 0; // elements
    Clock::time_point last_status_ = {};
    double time_at_status_ = 0;
    std::int64_t step_at_status_ = 0;
    bool blade_is_on_its_way_ = false; // told where to go since the last advance
    bool has_news_ = false;            // for a status while paused
};

} // namespace server
