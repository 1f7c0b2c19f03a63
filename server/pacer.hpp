// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "clients.hpp"

namespace server {

/// Ties simulated time to the clock: so much for every tick, less where the machine is too slow. What was
/// not done in time is never made up for, so that a slow machine shows slow motion, and no standstill.
class Pacer {
public:
    static constexpr std::chrono::microseconds tick{8333}; // 120 Hz

    /// Simulated seconds for this tick, in steps of `step` s. A quarter of the tick is for the rest: cutting,
    /// frames, and the machine's own.
    double seconds(double speed, double step) const {
        const double asked = speed * std::chrono::duration<double>(tick).count();
        const double budget = 0.75 * std::chrono::duration<double>(tick).count();
        return std::min(asked, budget / work_ * step);
    }

    /// Tells what `steps` took, s. By steps: a stiffer material makes more of them at once.
    void note(std::int64_t steps, double wall) {
        constexpr double weight = 0.1;
        if (steps > 0) { work_ += weight * (wall / static_cast<double>(steps) - work_); }
    }

    /// Simulated seconds that a second of work makes.
    double real_time_factor(double step) const { return step / work_; }

    /// When the tick after `now` begins.
    Clock::time_point next(Clock::time_point now) {
        due_ += tick;
        if (due_ < now) { due_ = now; }
        return due_;
    }

private:
    double work_ = 1e-3; // s of wall a step; at first a guess, on the safe side
    Clock::time_point due_ = {};
};

} // namespace server
