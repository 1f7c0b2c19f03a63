// SPDX-License-Identifier: Apache-2.0
#include "cut/cutter.hpp"

#include <fmt/format.h>
#include <utility>

#include "base/assert.hpp"
#include "base/clock.hpp"
#include "cut/pieces.hpp"
#include "cut/stages.hpp"
#include "cut/transaction.hpp"

namespace resect {
namespace {

void refuse(CutReport& report, std::string reason, const Vec3& where) {
    ++report.refused;
    report.reason = std::move(reason);
    report.where = where;
}

/// Above this a check after every cut takes longer than the cut by far: it is made only where it is asked
/// for.
[[maybe_unused]] constexpr std::size_t most_elements_verified = 2000;

bool is_verified(const Cutter& cutter) {
    bool wanted = cutter.setup.options.verify;
#ifdef RESECT_VERIFY
    wanted = wanted || cutter.element_volume.size() < most_elements_verified;
#endif
    return wanted;
}

/// Why the change that the increment made must not stand, or nothing.
std::string find_objection(const Cutter& cutter) {
    if (cutter.scratch.is_runaway) {
        return "more edges would be cut than one sweep can: sweep less at once";
    }
    if (const char* fault = find_fault(cutter)) { return fault; }
    return is_verified(cutter) ? find_broken_invariant(cutter) : "";
}

void begin_increment(Cutter& cutter, Delta& delta) {
    Scratch& scratch = cutter.scratch;
    delta.clear();
    scratch.queue.clear();
    scratch.dirty.clear();
    scratch.torn.clear();
    scratch.bisections = 0;
    scratch.is_runaway = false;
    scratch.queued.clear(cutter.material.tets.size());
}

/// Runs the stages up to the one that is told to fail, if any; false: that one was met.
bool run_stages(Cutter& cutter, Blade& blade, const Sweep& sweep, Delta& delta, CutReport& report) {
    Scratch& scratch = cutter.scratch;
    const BladeBox box = make_box(cutter, sweep);
    scratch.tissue = sweep.before;
    Stopwatch watch;
    find_near_copies(cutter, blade, sweep, box);
    refine_near(cutter, blade, sweep, box);
    if (cutter.failing == Stage::refine) { return false; }
    const std::size_t pending = blade.pending.size();
    detect_crossings(cutter, blade, sweep, box, report);
    cutter.tally.crossings += static_cast<std::int64_t>(blade.pending.size() - pending);
    queue_waiting(cutter, blade);
    report.us.detect += watch.lap();
    if (cutter.failing == Stage::detect) { return false; }
    if (scratch.dirty.empty()) { return true; }
    bisect_separated(cutter, blade);
    cutter.tally.bisections += scratch.bisections;
    report.us.bisect += watch.lap();
    if (cutter.failing == Stage::bisect) { return false; }
    tear_sheet(cutter, blade, report);
    report.us.tear += watch.lap();
    if (cutter.failing == Stage::tear) { return false; }
    if (!scratch.torn.empty()) {
        derive_simulation(cutter, delta, report);
        split_pieces(cutter);
    }
    report.us.derive += watch.lap();
    return cutter.failing != Stage::derive;
}

/// Makes the whole increment, or none of it: then the blade has passed without cutting.
void run_increment(Cutter& cutter, Blade& blade, const Sweep& sweep, Delta& delta, CutReport& report) {
    const CutReport before = report;
    begin_increment(cutter, delta);
    open_state(cutter);
    std::string objection = run_stages(cutter, blade, sweep, delta, report) ? "" : "told to fail";
    Stopwatch watch;
    if (objection.empty() && !cutter.scratch.dirty.empty()) { objection = find_objection(cutter); }
    report.us.check += watch.lap();
    if (objection.empty()) {
        note_surface_changes(cutter);
        close_state(cutter);
        if (cutter.scratch.bisections > 0 || !cutter.scratch.torn.empty()) { ++cutter.revision; }
        return;
    }
    take_back_state(cutter);
    delta.clear();
    const CutTimes us = report.us;
    report = before;
    report.us = us;
    refuse(report, fmt::format("the blade passed without cutting: {}", objection), sweep.to.tip);
}

/// The stroke of a blade that was lifted ended within a grain of the pose: marks or crossings there have not
/// expired.
bool ended_at(const Cutter& cutter, const Blade& lifted, const Edge& pose,
              std::span<const Vec3f> displacement) {
    const auto is_near = [&](const Vec3& place, Index vertex) {
        return distance_to(pose, place) <= cutter.material.grain[row(vertex)];
    };
    bool found = false;
    for (Index v = 0; !found && row(v) < lifted.sheet.size(); ++v) {
        found = is_zero(lifted, v) && is_near(displaced_position(cutter, v, displacement), v);
    }
    lifted.pending.each([&](Index u, Index w, const Crossing& crossing) {
        if (found || lifted.travel > crossing.expires) { return; }
        const Vec3 from = displaced_position(cutter, u, displacement);
        const Vec3 to = displaced_position(cutter, w, displacement);
        found = is_near(from + crossing.t * (to - from), u);
    });
    return found;
}

/// Gives the blade what another, or itself, left behind at the pose when it was lifted.
bool take_over_stroke(Cutter& cutter, Blade& blade, const Edge& pose, std::span<const Vec3f> displacement) {
    if (displacement.empty()) { return false; }
    for (Blade& lifted : cutter.blades) {
        if (lifted.placed || !ended_at(cutter, lifted, pose, displacement)) { continue; }
        if (&lifted != &blade) {
            std::swap(lifted.stroke, blade.stroke);
            std::swap(lifted.travel, blade.travel);
            std::swap(lifted.pending, blade.pending);
            std::swap(lifted.sheet, blade.sheet);
        }
        return true;
    }
    return false;
}

} // namespace

std::array<Index, 4> find_nodes(const Cutter& cutter, const Support& support, Index copy) {
    const Tet& element = cutter.element(copy);
    std::array<Index, 4> node = {-1, -1, -1, -1};
    for (std::size_t i = 0; i < 4; ++i) {
        if (support.node[i] < 0) { continue; }
        const std::size_t corner = corner_of(element, support.node[i]);
        RESECT_ASSERT(corner < 4);
        node[i] = cutter.mesh.copy_node[row(copy)][corner];
    }
    return node;
}

Vec3 displaced_position(const Cutter& cutter, Index vertex, std::span<const Vec3f> displacement) {
    const MaterialMesh& material = cutter.material;
    const Support& support = material.support[row(vertex)];
    const std::array<Index, 4> node =
        find_nodes(cutter, support, material.tet(material.any_tet[row(vertex)]).copy);
    Vec3 position = material.rest[row(vertex)];
    for (std::size_t i = 0; i < 4; ++i) {
        if (node[i] >= 0) { position += support.weight[i] * to_double(displacement[row(node[i])]); }
    }
    return position;
}

void place_blade(Cutter& cutter, Index blade, const Edge& pose, std::span<const Vec3f> displacement) {
    RESECT_ASSERT(blade >= 0);
    if (!is_sound(pose)) { return; }
    if (row(blade) >= cutter.blades.size()) { cutter.blades.resize(row(blade) + 1); }
    Blade& placed = cutter.blades[row(blade)];
    if (!take_over_stroke(cutter, placed, pose, displacement)) {
        placed.stroke = ++cutter.strokes;
        placed.travel = 0;
        placed.pending.clear();
    }
    placed.placed = true;
    placed.frame = make_frame(pose);
    placed.step = 0;
    placed.waiting.clear();
    placed.sheet.grow(cutter.material.rest.size(), {});
    placed.sheet.reserve(2);
    placed.approach = {};
}

void lift_blade(Cutter& cutter, Index blade) {
    if (has_blade(cutter, blade)) { cutter.blades[row(blade)].placed = false; }
}

bool has_blade(const Cutter& cutter, Index blade) {
    return blade >= 0 && row(blade) < cutter.blades.size() && cutter.blades[row(blade)].placed;
}

// NOLINTNEXTLINE(readability-function-size): one call a step, from one place
void sweep_blade(Cutter& cutter, Index blade, const Edge& to, std::span<const Vec3f> before,
                 std::span<const Vec3f> after, Delta& delta, CutReport& report) {
    delta.clear();
    if (!has_blade(cutter, blade)) {
        refuse(report, "a blade that is not placed cannot sweep: place it first", to.tip);
        return;
    }
    if (!is_sound(to)) {
        refuse(report, "a blade of no length or not finite cannot cut: give it two points apart", to.tip);
        return;
    }
    RESECT_ASSERT(before.size() == cutter.mesh.node_reference.size());
    RESECT_ASSERT(after.size() == cutter.mesh.node_reference.size());
    Blade& sweeping = cutter.blades[row(blade)];
    const Sweep sweep = {sweeping.frame, carry_frame(sweeping.frame, to), before, after};
    run_increment(cutter, sweeping, sweep, delta, report);
    sweeping.frame = sweep.to;
}

} // namespace resect
