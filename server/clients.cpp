// SPDX-License-Identifier: Apache-2.0
#include "clients.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "texts.hpp"

namespace server {

namespace {

constexpr std::size_t most_unseen = 2;
/// A little less than a sixtieth of a second, so that ticks that come at 120 Hz give frames at 60 Hz.
constexpr std::chrono::milliseconds between_frames(15);
constexpr std::chrono::seconds silence(3);

} // namespace

void Clients::join(ClientId client, const std::string& hello_driving, const std::string& hello_watching) {
    clients_[client].last_message = Clock::now();
    if (driver_ == 0) { driver_ = client; }
    send_text(client, is_driver(client) ? hello_driving : hello_watching);
}

bool Clients::leave(ClientId client) {
    clients_.erase(client);
    if (!is_driver(client)) { return false; }
    driver_ = clients_.empty() ? 0 : clients_.begin()->first;
    return true;
}

void Clients::note_message(ClientId client, Clock::time_point now) {
    const auto found = clients_.find(client);
    if (found != clients_.end()) { found->second.last_message = now; }
}

void Clients::note_seen(ClientId client, std::uint32_t frame) {
    const auto found = clients_.find(client);
    if (found == clients_.end()) { return; }
    std::erase_if(found->second.unseen, [&](std::uint32_t sent) { return sent <= frame; });
}

void Clients::note_show(ClientId client, const Show& show) {
    const auto found = clients_.find(client);
    if (found == clients_.end()) { return; }
    found->second.has.show = show;
    found->second.has_frame = false;
    if (!show.elements) { found->second.has.has_elements = false; }
}

bool Clients::take_wheel(ClientId client, Clock::time_point now) {
    const auto driver = clients_.find(driver_);
    if (driver != clients_.end() && now - driver->second.last_message < silence) { return false; }
    driver_ = client;
    return true;
}

void Clients::send_text(ClientId client, std::string text) const {
    send_(client, std::make_shared<const std::string>(std::move(text)), false);
}

void Clients::send_bytes(ClientId client, std::string bytes) const {
    send_(client, std::make_shared<const std::string>(std::move(bytes)), true);
}

void Clients::send_text_to_all(const std::string& text) const {
    const auto shared = std::make_shared<const std::string>(text);
    for (const auto& [id, client] : clients_) {
        send_(id, shared, false);
    }
}

void Clients::send_status(const std::string& text) const {
    const auto shared = std::make_shared<const std::string>(text);
    for (const auto& [id, client] : clients_) {
        if (client.unseen.size() < most_unseen) { send_(id, shared, false); }
    }
}

void Clients::announce_driver() const {
    for (const auto& [id, client] : clients_) {
        send_text(id, driving_text(is_driver(id), clients_.size()));
    }
}

bool Clients::is_ready(const Client& client, Clock::time_point now) {
    return client.unseen.size() < most_unseen && now - client.last_frame >= between_frames;
}

void Clients::publish(resect::Simulation& simulation, FrameHeader header, Clock::time_point now) {
    struct Built {
        FrameRequest request = {};
        std::shared_ptr<const std::string> bytes = {};
        std::uint64_t revision = 0;
    };
    std::vector<Built> built; // clients that have the same get the same bytes
    header.frame = ++frame_;
    for (auto& [id, client] : clients_) {
        if (!is_ready(client, now)) { continue; }
        FrameHeader& shown = client.shown;
        if (shown.scene != header.scene) { client.has = {.show = client.has.show}; }
        const bool is_news = !client.has_frame || shown.scene != header.scene || shown.step != header.step ||
                             shown.message != header.message;
        if (!is_news) { continue; }
        auto found = std::find_if(built.begin(), built.end(),
                                  [&has = client.has](const Built& one) { return one.request == has; });
        if (found == built.end()) {
            std::uint64_t revision = 0;
            std::string bytes = build_frame(simulation, header, client.has, revision);
            built.push_back({client.has, std::make_shared<const std::string>(std::move(bytes)), revision});
            found = built.end() - 1;
        }
        send_(id, found->bytes, true);
        client.unseen.push_back(header.frame);
        client.last_frame = now;
        client.has.since_revision = found->revision;
        client.has.has_elements = client.has.show.elements;
        client.has_frame = true;
        shown = header;
    }
}

} // namespace server
