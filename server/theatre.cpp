// SPDX-License-Identifier: Apache-2.0
#include "theatre.hpp"

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <utility>

namespace server {

namespace {

using namespace resect;

constexpr std::chrono::milliseconds between_statuses(100);

double seconds_since(Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
}

std::string stamp() {
    const std::time_t now = std::time(nullptr);
    std::tm local = {};
    localtime_r(&now, &local);
    char text[32] = {};
    std::strftime(text, sizeof(text), "%Y%m%d_%H%M%S", &local);
    return text;
}

std::string read_bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Elements that have more than one copy; a lattice has a few that no cut made.
Index count_split_elements(const Copies& copies) {
    std::vector<std::uint8_t> seen(copies.element.size(), 0); // times, at most 2
    Index count = 0;
    for (const Index element : copies.element) {
        std::uint8_t& times = seen[static_cast<std::size_t>(element)];
        if (times == 1) { ++count; }
        times = static_cast<std::uint8_t>(std::min(times + 1, 2));
    }
    return count;
}

} // namespace

Theatre::Theatre(TheatreOptions options, Inbox& inbox, Send send)
    : options_(std::move(options)), inbox_(inbox), clients_(std::move(send)) {}

void Theatre::run() {
    while (!inbox_.is_closed()) {
        const Clock::time_point began = Clock::now();
        for (const Event& event : inbox_.take()) {
            handle(event);
        }
        if (is_running()) { advance(pacer_.seconds(speed_, scene_->simulation().time_step().used)); }
        publish(Clock::now());
        figures_.tick_ms = std::max(figures_.tick_ms, 1e3 * seconds_since(began));
        inbox_.wait_until(pacer_.next(Clock::now()));
        if (!is_running() && !has_news_) { inbox_.wait(); }
    }
}

void Theatre::handle(const Event& event) {
    has_news_ = true;
    if (std::holds_alternative<Joined>(event.what)) {
        clients_.join(event.client, hello_text(true, options_.scenes), hello_text(false, options_.scenes));
        clients_.send_text(event.client, scene_text(scene_->facts()));
        clients_.announce_driver();
    } else if (std::holds_alternative<Left>(event.what)) {
        if (clients_.leave(event.client)) { scene_->let_go(); }
        clients_.announce_driver();
    } else {
        hear(event.client, std::get<Message>(event.what));
    }
}

void Theatre::hear(ClientId client, const Message& message) {
    clients_.note_message(client, Clock::now());
    const bool is_driver = clients_.is_driver(client);
    if (!is_driver && !is_for_watchers(message.request)) {
        refuse(client, message.id, "another page drives; this one watches, and may ask to take over");
        return;
    }
    answer(client, message.id, message.request);
    if (is_driver && message.id > 0) { last_message_ = message.id; }
}

void Theatre::answer(ClientId client, Index id, const Request& request) {
    if (const auto* seen = std::get_if<Seen>(&request)) { clients_.note_seen(client, seen->frame); }
    if (const auto* told = std::get_if<Tell>(&request)) { tell(client, id, told->command); }
    if (const auto* pause = std::get_if<Pause>(&request)) { paused_ = pause->paused; }
    if (const auto* steps = std::get_if<TakeSteps>(&request)) { take_steps(steps->steps); }
    if (const auto* speed = std::get_if<SetSpeed>(&request)) { speed_ = speed->speed; }
    if (const auto* show = std::get_if<Show>(&request)) { clients_.note_show(client, *show); }
    if (const auto* wanted = std::get_if<Save>(&request)) { save(client, id, wanted->what); }
    if (std::holds_alternative<AskHash>(request)) {
        clients_.send_text(client, hash_text(id, scene_->simulation()));
    }
    if (std::holds_alternative<Reset>(request)) { start(client, id, SceneEntry(scene_->entry())); }
    if (std::holds_alternative<Drive>(request)) {
        if (!clients_.take_wheel(client, Clock::now())) {
            refuse(client, id, "another page drives, and is alive; ask whoever sits there");
        }
        clients_.announce_driver();
    }
    if (const auto* asked = std::get_if<StartScene>(&request)) {
        const auto found = std::find_if(options_.scenes.begin(), options_.scenes.end(),
                                        [&](const SceneEntry& one) { return one.name == asked->name; });
        if (found == options_.scenes.end()) {
            refuse(client, id, "scene: there is none of this name; hello lists them");
        } else {
            start(client, id, *found);
        }
    }
    if (const auto* upload = std::get_if<Upload>(&request)) {
        const Result<SceneEntry> entry = write_scene_of(*upload, options_.folder);
        if (entry) { start(client, id, *entry); }
        if (!entry) { refuse(client, id, entry.error().message); }
    }
}

void Theatre::tell(ClientId client, Index id, const Command& command) {
    // A blade's last way would be lost with it; so also what is cut while paused.
    const bool is_lift = std::holds_alternative<LiftBlade>(command);
    if (is_lift && blade_is_on_its_way_ && !figures_.diverged) { take_step(); }
    blade_is_on_its_way_ = std::holds_alternative<MoveBlade>(command) || (blade_is_on_its_way_ && !is_lift);
    const Result<void> applied = scene_->apply(command);
    if (!applied) {
        refuse(client, id, applied.error().message);
    } else if (std::holds_alternative<Undo>(command)) {
        figures_.diverged = false;
        figures_.reason.clear();
    }
}

void Theatre::start(ClientId client, Index id, const SceneEntry& entry) {
    const Result<void> started = start(entry);
    if (!started) {
        refuse(client, id, started.error().message);
        clients_.send_text_to_all(scene_text(scene_->facts()));
    }
}

Result<void> Theatre::start(const SceneEntry& entry) {
    clients_.send_text_to_all(loading_text(entry.title));
    Result<LiveScene> started = LiveScene::start(entry, options_.threads);
    if (!started) { return started.error(); }
    scene_.emplace(std::move(*started));
    scene_->number(++scene_number_);
    pacer_ = {};
    figures_ = {};
    split_at_start_ = count_split_elements(scene_->simulation().copies());
    paused_ = false;
    speed_ = 1;
    time_at_status_ = scene_->simulation().time();
    step_at_status_ = scene_->simulation().steps();
    clients_.send_text_to_all(scene_text(scene_->facts()));
    return {};
}

void Theatre::save(ClientId client, Index id, const std::string& what) {
    const bool is_record = what == "record";
    const std::string file =
        is_record ? fmt::format("record_{}_{}.json", scene_->entry().name, stamp()) : what;
    const std::string path = fmt::format("{}/{}", options_.folder, file);
    std::error_code failed;
    std::filesystem::create_directories(options_.folder, failed);
    if (const Result<void> saved = scene_->save(path); !saved) {
        refuse(client, id, saved.error().message);
        return;
    }
    clients_.send_bytes(client, build_file(file, read_bytes(path)));
    clients_.send_text(client, saved_text(id, path, file));
}

void Theatre::refuse(ClientId client, Index id, const std::string& message) {
    clients_.send_text(client, refused_text(id, message));
}

void Theatre::advance(double seconds) {
    Simulation& simulation = scene_->simulation();
    const double step = simulation.time_step().used;
    blade_is_on_its_way_ = false;
    const Clock::time_point began = Clock::now();
    const StepReport report = simulation.advance(std::max(seconds, step));
    const double cut = report.cut.us.total();
    pacer_.note(report.steps, seconds_since(began) - 1e-6 * cut);
    figures_.cut_us = std::max(figures_.cut_us, cut);
    if (report.status == Status::diverged) {
        figures_.diverged = true;
        figures_.reason = report.reason;
        clients_.send_text_to_all(notice_text(report.reason));
    }
    if (report.cut.refused > 0) { clients_.send_text_to_all(notice_text(report.cut.reason)); }
}

void Theatre::take_steps(Index steps) {
    if (!paused_) { return; }
    for (Index i = 0; i < steps && !figures_.diverged; ++i) {
        take_step();
    }
}

/// Exactly one: what is carried over from ticks may make a first advance one of none.
void Theatre::take_step() {
    const Simulation& simulation = scene_->simulation();
    const std::int64_t before = simulation.steps();
    for (int i = 0; i < 2 && simulation.steps() == before && !figures_.diverged; ++i) {
        advance(simulation.time_step().used);
    }
}

void Theatre::publish(Clock::time_point now) {
    Simulation& simulation = scene_->simulation();
    clients_.publish(simulation,
                     {.message = static_cast<std::uint32_t>(last_message_),
                      .scene = scene_number_,
                      .time = simulation.time(),
                      .step = static_cast<double>(simulation.steps())},
                     now);
    figures_.surface_us = std::max(figures_.surface_us, 1e6 * seconds_since(now));
    if (now - last_status_ < between_statuses) { return; }
    const double passed = std::chrono::duration<double>(now - last_status_).count();
    figures_.paused = paused_;
    figures_.speed = speed_;
    figures_.pace = (simulation.time() - time_at_status_) / passed;
    figures_.step_rate = static_cast<double>(simulation.steps() - step_at_status_) / passed;
    figures_.real_time_factor = pacer_.real_time_factor(simulation.time_step().used);
    figures_.clients = clients_.count();
    if (clients_.count() > 0) {
        figures_.cut_elements = count_split_elements(simulation.copies()) - split_at_start_;
        clients_.send_status(status_text(simulation, figures_));
    }
    figures_.tick_ms = figures_.cut_us = figures_.surface_us = 0;
    last_status_ = now;
    time_at_status_ = simulation.time();
    step_at_status_ = simulation.steps();
    has_news_ = false;
}

} // namespace server
