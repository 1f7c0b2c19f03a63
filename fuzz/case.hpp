// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "resect/commands.hpp"

#include "bodies.hpp"

namespace resect::fuzz {

/// Blades that move together: each is placed at its first pose and lifted after its last. All have as many.
struct Stroke {
    std::vector<std::vector<Edge>> blades = {}; // [blade][pose]
    Index increments = 1;                       // from a pose to the next, over which the ends move linearly
    double seconds = 0;                         // that it takes; simulations only
    bool is_still = false; // the tissue is held still; simulations only, one blade, two poses
};

/// Tissue that waves while it is cut.
struct Waves {
    double size = 0;  // m
    double pace = 0;  // rad in a stroke
    double phase = 0; // rad
};

/// What moves a body that is not made to wave.
struct Forces {
    double young = 2e4;           // Pa
    double damping = 0;           // 1/s
    Vec3 gravity = {0, 0, -9.81}; // m/s^2
    double kick = 0;              // m/s, of the fastest nodes at the start
};

/// What must be true in the end, beside what must always be.
struct Expected {
    Index pieces = -1;         // -1: unknown
    bool is_unpinched = false; // no edge of the surface has four triangles
    bool is_on_sheet = false;  // torn faces lie where the blade went
};

/// Strokes through a body, in full: nothing is drawn when it is run again.
struct Case {
    std::string what = {};
    std::uint64_t seed = 0;    // that it was drawn from; 0: made by hand
    bool is_simulated = false; // else the cutter alone, with the motion of `waves`
    BodySpec body = {};
    Waves waves = {};
    Forces forces = {};
    std::vector<Stroke> strokes = {};
    Expected expected = {};
};

/// The tissue's place at a time from 0 to 1 of a stroke.
Vec3 wave(const Waves& waves, const Vec3& rest, double time);

/// Increments of a stroke, and where a blade is after so many of them.
Index count_increments(const Stroke& stroke);
Edge pose_after(const Stroke& stroke, std::size_t blade, Index increments);

void write_case(const std::string& path, const Case& written);
Result<Case> read_case(const std::string& path);

} // namespace resect::fuzz
