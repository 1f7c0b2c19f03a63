// SPDX-License-Identifier: Apache-2.0
#include <set>

#include "cut/stages.hpp"
#include "strokes.hpp"

namespace resect {
namespace {

/// Copies whose nodes do not all stay beyond one side of the blade's box, by a look at every one.
std::set<Index> find_all_near(const Cutter& cutter, const Sweep& sweep) {
    const BladeBox box = make_box(cutter, sweep);
    std::set<Index> near;
    for (std::size_t copy = 0; copy < cutter.mesh.copy_node.size(); ++copy) {
        unsigned common = 63;
        for (const Index node : cutter.mesh.copy_node[copy]) {
            const Vec3& rest = rest_of_node(cutter, node);
            common &= sides_beyond(box, to_frame(sweep.from, rest + to_double(sweep.before[row(node)])));
            common &= sides_beyond(box, to_frame(sweep.to, rest + to_double(sweep.after[row(node)])));
        }
        if (common == 0) { near.insert(static_cast<Index>(copy)); }
    }
    return near;
}

/// Tissue that sways and turns, rests for a while, then falls fast.
Vec3 sway(Vec3 p, double time) {
    const double angle = time < 0.5 ? 0.4 * std::sin(6 * time) : 0.4 * std::sin(3.0);
    const double drop = time < 0.7 ? 0 : 8 * (time - 0.7) * (time - 0.7);
    return {std::cos(angle) * p[0] - std::sin(angle) * p[2], p[1] + 0.1 * std::sin(4 * p[0] + 5 * angle),
            std::sin(angle) * p[0] + std::cos(angle) * p[2] - drop};
}

/// A blade that goes through the body while it tilts and turns, and leaps at times.
Edge tumble(double time) {
    const double leap = static_cast<int>(10 * time) % 3 == 2 ? 0.11 : 0;
    const Vec3 tip = {0.1 + 0.8 * time + leap, 0.35 - 0.3 * std::cos(7 * time),
                      0.2 + 0.2 * std::sin(5 * time)};
    return {tip + Vec3{0.5 * std::sin(3 * time), 0.4 * std::cos(9 * time), 0.8}, tip};
}

TEST_CASE("the copies that a blade may meet are those that a look at every one finds") {
    const CutterPtr cutter = cutter_of(make_cube(8, 0.2, 3));
    place_blade(*cutter, 0, tumble(0));
    std::size_t met = 0;
    constexpr std::size_t sweeps = 400;
    const auto share = [](std::size_t i) { return static_cast<double>(i) / sweeps; };
    for (std::size_t i = 1; i <= sweeps; ++i) {
        if (i % 100 == 0) { // a leap that no number of moves makes up for
            Delta delta;
            CutReport report;
            const std::vector<Vec3f> now = displacements(*cutter, sway, share(i - 1));
            for (const double far : {1e200, 3.0}) {
                sweep_blade(*cutter, 0, {{0, -far, 1}, {0, -far, 0}}, now, now, delta, report);
            }
        }
        const std::vector<Vec3f> before = displacements(*cutter, sway, share(i - 1));
        const std::vector<Vec3f> after = displacements(*cutter, sway, share(i));
        const BladeFrame& from = cutter->blades[0].frame;
        const Edge to = tumble(share(i));
        const std::set<Index> all = find_all_near(*cutter, {from, carry_frame(from, to), before, after});
        Delta delta;
        CutReport report;
        sweep_blade(*cutter, 0, to, before, after, delta, report);
        const std::vector<Index>& near = cutter->scratch.near_copies;
        CHECK(std::set<Index>(near.begin(), near.end()) == all);
        CHECK(near.size() == all.size());
        met += all.size();
    }
    CHECK(met > 10 * sweeps);
    CHECK(cutter->mesh.copy_node.size() > cutter->element_volume.size());
}

} // namespace
} // namespace resect
