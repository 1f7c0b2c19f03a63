// SPDX-License-Identifier: Apache-2.0
#include "scene_run.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cli {

namespace {

using namespace resect;

constexpr double frame = 1.0 / 60;      // s
constexpr double increment_time = 1e-3; // s between two sweeps of a blade, where steps are shorter
constexpr double steps_at_most = 1e9;
constexpr std::size_t blades_at_most = 64;
constexpr double farthest = 1e6; // m

Edge pose_at(const std::vector<BladeKey>& path, double time) {
    const auto after =
        std::find_if(path.begin(), path.end(), [&](const BladeKey& key) { return key.time > time; });
    if (after == path.begin()) { return path.front().edge; }
    if (after == path.end()) { return path.back().edge; }
    const BladeKey &a = *std::prev(after), &b = *after;
    const double t = (time - a.time) / (b.time - a.time);
    const auto mix = [t](const Vec3& p, const Vec3& q) {
        return Vec3{p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])};
    };
    return {mix(a.edge.heel, b.edge.heel), mix(a.edge.tip, b.edge.tip)};
}

void add(CutReport& sum, const CutReport& part) {
    sum.elements_cut += part.elements_cut;
    sum.copies_added += part.copies_added;
    sum.nodes_added += part.nodes_added;
    sum.pieces = part.pieces;
    sum.refused += part.refused;
    sum.area += part.area;
    if (!part.reason.empty()) {
        sum.reason = part.reason;
        sum.where = part.where;
    }
}

} // namespace

SceneRun::SceneRun(const Scene& scene, Simulation simulation)
    : scene_(scene), simulation_(std::move(simulation)), blades_(scene.blades.size()) {}

StepReport SceneRun::settle() {
    if (!scene_.settle) { return {}; }
    StepReport report = simulation_.settle(scene_.settling.residual, scene_.settling.at_most);
    figures_.status = report.status;
    figures_.reason = report.reason;
    return report;
}

/// A pose between two keys may be refused where the keys themselves are not: heel and tip may meet on the
/// way.
void SceneRun::apply(const Command& command) {
    const Result<void> applied = simulation_.apply(command);
    if (applied) { return; }
    ++figures_.cut.refused;
    figures_.cut.reason = applied.error().message;
}

void SceneRun::move_blades(double begin, double end) {
    for (std::size_t b = 0; b < blades_.size(); ++b) {
        const std::vector<BladeKey>& path = scene_.blades[b];
        const Index id = static_cast<Index>(b);
        if (blades_[b].lifted || path.front().time >= end) { continue; }
        if (!blades_[b].placed) {
            apply(MoveBlade{id, path.front().edge});
            blades_[b].placed = true;
        }
        for (const BladeKey& key : path) {
            if (key.time > begin && key.time <= end && key.time > path.front().time) {
                apply(MoveBlade{id, key.edge});
            }
        }
        if (end < path.back().time) { apply(MoveBlade{id, pose_at(path, end)}); }
    }
}

void SceneRun::lift_blades(double end) {
    for (std::size_t b = 0; b < blades_.size(); ++b) {
        if (!blades_[b].placed || blades_[b].lifted || scene_.blades[b].back().time > end) { continue; }
        apply(LiftBlade{static_cast<Index>(b)});
        blades_[b].lifted = true;
    }
}

void SceneRun::increment(std::int64_t steps) {
    const double begin = simulation_.time(),
                 seconds = static_cast<double>(steps) * simulation_.time_step().used;
    move_blades(begin, begin + seconds);
    const bool cutting = std::any_of(blades_.begin(), blades_.end(),
                                     [](const Blade& blade) { return blade.placed && !blade.lifted; });
    Timer timer;
    const StepReport report = simulation_.advance(seconds);
    const double wall = timer.lap();
    lift_blades(begin + seconds);

    figures_.steps += report.steps;
    figures_.simulated += static_cast<double>(report.steps) * simulation_.time_step().used;
    figures_.element_updates +=
        static_cast<double>(report.steps) * static_cast<double>(simulation_.copies().node.size());
    figures_.wall += wall;
    frame_wall_ += wall;
    add(figures_.cut, report.cut);
    if (cutting) { figures_.cut_us.add(report.cut.us.total()); }
    if (report.steps > 0) {
        figures_.step_us.add((1e6 * wall - report.cut.us.total()) / static_cast<double>(report.steps));
    }
    if (report.status != Status::ok) {
        figures_.status = report.status;
        figures_.reason = report.reason;
    }
}

Result<void> SceneRun::check(double seconds) const {
    const double steps = seconds / simulation_.time_step().used;
    if (steps > steps_at_most) {
        return Error{fmt::format("{:g} s in steps of {:g} s are {:.2g} steps; give fewer than {:g}", seconds,
                                 simulation_.time_step().used, steps, steps_at_most)};
    }
    if (scene_.blades.size() > blades_at_most) {
        return Error{fmt::format("{} blades; give at most {}", scene_.blades.size(), blades_at_most)};
    }
    for (std::size_t blade = 0; blade < scene_.blades.size(); ++blade) {
        for (const BladeKey& key : scene_.blades[blade]) {
            for (const Vec3& end : {key.edge.heel, key.edge.tip}) {
                if (std::abs(end[0]) <= farthest && std::abs(end[1]) <= farthest &&
                    std::abs(end[2]) <= farthest) {
                    continue;
                }
                return Error{fmt::format("blades[{}]: a pose is farther than {:g} m away", blade, farthest)};
            }
        }
    }
    return {};
}

void SceneRun::finish_frame() {
    Timer timer;
    simulation_.surface();
    const double wall = timer.lap();
    figures_.wall += wall;
    figures_.frame_ms.add(1e3 * (frame_wall_ + wall));
    frame_wall_ = 0;
}

void SceneRun::run(double seconds, double every, const std::function<void(double)>& look) {
    const double step = simulation_.time_step().used;
    const std::int64_t steps = static_cast<std::int64_t>(std::ceil(seconds / step - 1e-9));
    const std::int64_t stride = std::max<std::int64_t>(1, static_cast<std::int64_t>(increment_time / step));
    look(0);
    for (double next_frame = frame, next_look = every; figures_.steps < steps;) {
        increment(std::min(stride, steps - figures_.steps));
        const double time = simulation_.time();
        const bool over = figures_.status == Status::diverged || figures_.status == Status::refused ||
                          figures_.steps >= steps;
        if (over || time >= next_frame - step / 2) {
            finish_frame();
            next_frame += frame;
        }
        if (over || time >= next_look - step / 2) {
            look(time);
            next_look += every;
        }
        if (over) { break; }
    }
}

double find_opening(const Surface& surface) {
    std::vector<Index> torn;
    for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
        if (surface.face[t] == 0) { continue; }
        torn.insert(torn.end(), surface.triangle[t].begin(), surface.triangle[t].end());
    }
    const auto rest = [&](Index vertex) -> const Vec3f& {
        return surface.rest[static_cast<std::size_t>(vertex)];
    };
    std::sort(torn.begin(), torn.end());
    torn.erase(std::unique(torn.begin(), torn.end()), torn.end());
    std::stable_sort(torn.begin(), torn.end(), [&](Index a, Index b) { return rest(a) < rest(b); });
    double opening = 0;
    for (std::size_t a = 0; a < torn.size(); ++a) {
        for (std::size_t b = a + 1; b < torn.size() && rest(torn[b]) == rest(torn[a]); ++b) {
            const Vec3f &p = surface.position[static_cast<std::size_t>(torn[a])],
                        &q = surface.position[static_cast<std::size_t>(torn[b])];
            const auto distance = double(std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
            opening = std::max(opening, distance);
        }
    }
    return opening;
}

} // namespace cli
