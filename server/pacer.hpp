// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "clients.hpp"

namespace server {

/// Ties simulated time to the clock: so much for every tick, less where the machine is too slow. What was
/// not done in time is never made up for, so that a slow machine shows slow motion, and no standstill.
class Pacer {
public:
    static constexpr std::chrono::microseconds tick{8333}; // 120 Hz

    /// Simulated seconds for this tick. Half of it is for the rest: cutting, frames, and the machine's own.
    double seconds(double speed) const {
        const double asked = speed * std::chrono::duration<double>(tick).count();
        const double budget = 0.75 * std::chrono::duration<double>(tick).count();
        return work_ > 0 ? std::min(asked, budget / work_) : asked;
    }

    /// Tells what an advance of `simulated` s took.
    void note(double simulated, double wall) {
        constexpr double weight = 0.1;
        if (!(simulated > 0)) { return; }
        const double work = wall / simulated;
        work_ += (work_ > 0 ? weight : 1) * (work - work_);
    }

    /// Simulated seconds that a second of work makes.
    double real_time_factor() const { return work_ > 0 ? 1 / work_ : 0; }

    /// When the tick after `now` begins.
    Clock::time_point next(Clock::time_point now) {
        due_ += tick;
        if (due_ < now) { due_ = now; }
        return due_;
    }

private:
    double work_ = 0; // s of wall a simulated second
    Clock::time_point due_ = {};
};

} // namespace server
