// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "frame.hpp"

namespace server {

using ClientId = std::uint32_t;
using Clock = std::chrono::steady_clock;

/// Gives bytes to a client; returns at once. Texts, and binary frames.
using Send = std::function<void(ClientId client, std::shared_ptr<const std::string> bytes, bool is_binary)>;

/// The pages that are connected: who drives, and which frames each has. Lives on the simulation's thread.
class Clients {
public:
    explicit Clients(Send send) : send_(std::move(send)) {}

    void join(ClientId client, const std::string& hello_driving, const std::string& hello_watching);
    /// True if it was the driver.
    bool leave(ClientId client);
    void note_message(ClientId client, Clock::time_point now);
    void note_seen(ClientId client, std::uint32_t frame);
    void note_show(ClientId client, const Show& show);
    /// Makes it the driver if nobody is, or the driver has been silent.
    bool take_wheel(ClientId client, Clock::time_point now);
    bool is_driver(ClientId client) const { return client == driver_; }
    std::size_t count() const { return clients_.size(); }

    void send_text(ClientId client, std::string text) const;
    void send_bytes(ClientId client, std::string bytes) const;
    void send_text_to_all(const std::string& text) const;
    /// Not to those that are behind with their frames.
    void send_status(const std::string& text) const;
    /// Tells all who drives.
    void announce_driver() const;

    /// Sends a frame to each client that is ready for one and lacks what the simulation has to show.
    void publish(resect::Simulation& simulation, FrameHeader header, Clock::time_point now);

private:
    struct Client {
        FrameRequest has = {};
        FrameHeader shown = {};
        bool has_frame = false;
        std::vector<std::uint32_t> unseen = {}; // frames on their way
        Clock::time_point last_frame = {}, last_message = {};
    };
    static bool is_ready(const Client& client, Clock::time_point now);

    Send send_;
    std::map<ClientId, Client> clients_ = {};
    ClientId driver_ = 0; // 0: nobody
    std::uint32_t frame_ = 0;
};

} // namespace server
