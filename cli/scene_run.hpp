// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "resect/resect.hpp"

#include "samples.hpp"

namespace cli {

/// What a run of a scene has measured.
struct RunFigures {
    resect::Status status = resect::Status::ok;
    std::string reason = {};
    resect::CutReport cut = {};
    std::int64_t steps = 0;
    double simulated = 0; // s
    double wall = 0;      // s of stepping, cutting and surface
    Samples frame_ms = {}, step_us = {}, cut_us = {};
    double element_updates = 0;
};

/// Simulated over wall time; 0 before the first step.
inline double real_time_factor(const RunFigures& figures) {
    return figures.wall > 0 ? figures.simulated / figures.wall : 0;
}

/// A scene's simulation, driven step by step: blades follow their paths, frames are surfaced and measured.
class SceneRun {
public:
    SceneRun(const resect::Scene& scene, resect::Simulation simulation);

    /// Whether the scene can be run for so long with these blades.
    resect::Result<void> check(double seconds) const;
    /// To the scene's settled start; times count from its end.
    resect::StepReport settle();
    /// Runs for `seconds`; `look` is called with the time at 0, every `every` seconds and at the end, off the
    /// clock.
    void run(double seconds, double every, const std::function<void(double)>& look);

    resect::Simulation& simulation() { return simulation_; }
    const RunFigures& figures() const { return figures_; }

private:
    struct Blade {
        bool placed = false, lifted = false;
    };
    void apply(const resect::Command& command);
    void increment(std::int64_t steps);
    void move_blades(double begin, double end);
    void lift_blades(double end);
    void finish_frame();

    const resect::Scene& scene_;
    resect::Simulation simulation_;
    std::vector<Blade> blades_;
    RunFigures figures_ = {};
    double frame_wall_ = 0; // s, of the frame that is going on
};

/// Largest distance between the two sides of the cut, m: between vertices that were one.
double find_opening(const resect::Surface& surface);

} // namespace cli
