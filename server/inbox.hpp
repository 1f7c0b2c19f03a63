// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <mutex>
#include <utility>
#include <variant>
#include <vector>

#include "clients.hpp"

namespace server {

struct Joined {};
struct Left {};

struct Event {
    ClientId client = 0;
    std::variant<Joined, Left, Message> what = {};
};

/// What the network has heard, for the simulation's thread.
class Inbox {
public:
    void put(Event event) {
        {
            const std::lock_guard lock(mutex_);
            events_.push_back(std::move(event));
        }
        changed_.notify_one();
    }

    /// Ends every wait, now and later.
    void close() {
        {
            const std::lock_guard lock(mutex_);
            closed_ = true;
        }
        changed_.notify_one();
    }

    bool is_closed() {
        const std::lock_guard lock(mutex_);
        return closed_;
    }

    std::vector<Event> take() {
        const std::lock_guard lock(mutex_);
        return std::exchange(events_, {});
    }

    /// Until there is an event.
    void wait() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return closed_ || !events_.empty(); });
    }

    /// Until `time`, whatever comes; a closed one does not wait.
    void wait_until(Clock::time_point time) {
        std::unique_lock lock(mutex_);
        changed_.wait_until(lock, time, [&] { return closed_; });
    }

private:
    std::mutex mutex_ = {};
    std::condition_variable changed_ = {};
    std::vector<Event> events_ = {};
    bool closed_ = false;
};

} // namespace server
