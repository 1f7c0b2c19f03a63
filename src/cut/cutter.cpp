// SPDX-License-Identifier: Apache-2.0
#include "cut/cutter.hpp"

#include "base/assert.hpp"
#include "base/clock.hpp"
#include "cut/stages.hpp"

namespace resect {
namespace {

void refuse(CutReport& report, const char* reason, const Vec3& where) {
    ++report.refused;
    report.reason = reason;
    report.where = where;
}

/// Above this a check after every cut takes longer than the cut by far: it is made only where it is asked
/// for.
[[maybe_unused]] constexpr std::size_t most_elements_verified = 2000;

void verify(const Cutter& cutter) {
    bool wanted = cutter.setup.options.verify;
#ifdef RESECT_VERIFY
    wanted = wanted || cutter.element_volume.size() < most_elements_verified;
#endif
    if (!wanted) { return; }
    const std::string broken = find_broken_invariant(cutter);
    if (!broken.empty()) { fail_assertion(broken.c_str(), __FILE__, __LINE__); }
}

void run_stages(Cutter& cutter, Blade& blade, const Sweep& sweep, Delta& delta, CutReport& report) {
    Scratch& scratch = cutter.scratch;
    scratch.queue.clear();
    scratch.dirty.clear();
    scratch.bisections = 0;
    scratch.queued.clear(cutter.material.tets.size());
    Stopwatch watch;
    detect_crossings(cutter, blade, sweep, report);
    report.us.detect += watch.lap();
    if (scratch.dirty.empty()) { return; }
    bisect_separated(cutter, blade);
    report.us.bisect += watch.lap();
    tear_sheet(cutter, blade, report);
    report.us.tear += watch.lap();
    if (!scratch.torn.empty()) { derive_simulation(cutter, delta, report); }
    report.us.derive += watch.lap();
    if (scratch.bisections == 0 && scratch.torn.empty()) { return; }
    ++cutter.revision;
    verify(cutter);
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

void place_blade(Cutter& cutter, Index blade, const Edge& pose) {
    RESECT_ASSERT(blade >= 0);
    if (!is_sound(pose)) { return; }
    if (row(blade) >= cutter.blades.size()) { cutter.blades.resize(row(blade) + 1); }
    Blade& placed = cutter.blades[row(blade)];
    placed.placed = true;
    placed.stroke = ++cutter.strokes;
    placed.frame = make_frame(pose);
    placed.pending.clear();
    placed.sheet.resize(cutter.material.rest.size(), 0);
    placed.normal.resize(cutter.material.rest.size());
}

void lift_blade(Cutter& cutter, Index blade) {
    if (!has_blade(cutter, blade)) { return; }
    cutter.blades[row(blade)].placed = false;
    cutter.blades[row(blade)].pending.clear();
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
    run_stages(cutter, sweeping, sweep, delta, report);
    sweeping.frame = sweep.to;
}

} // namespace resect
