// SPDX-License-Identifier: Apache-2.0
#include "cut/homes.hpp"

#include <limits>

namespace resect {
namespace {

bool holds(const HeldRegion& region, const Vec3& rest, const Support& support) {
    if (region.node_marked.empty()) { return is_inside(region.box, rest); }
    for (const Index node : support.node) {
        if (node >= 0 && region.node_marked[row(node)] == 0) { return false; }
    }
    return true;
}

} // namespace

Index find_home(const Cutter& cutter, std::span<const Index> pairs, Index reference) {
    const Vec3& goal = cutter.body.elements.nodes[row(reference)];
    double nearest = std::numeric_limits<double>::infinity();
    Index home = -1;
    for (const Index pair : pairs) {
        for (Index m = cutter.first_tet[row(pair / 4)]; m >= 0; m = cutter.material.tet(m).next) {
            for (const Index v : cutter.material.tet(m).vertex) {
                const Vec3 r = cutter.material.rest[row(v)] - goal;
                const double distance = dot(r, r);
                if (distance > nearest || (distance == nearest && v >= home)) { continue; }
                nearest = distance;
                home = v;
            }
        }
        if (nearest == 0) { break; }
    }
    return home;
}

void update_home(Cutter& cutter, Index node, std::span<const Index> pairs) {
    SimulationMesh& mesh = cutter.mesh;
    const Index home = find_home(cutter, pairs, mesh.node_reference[row(node)]);
    mesh.node_home.edit(row(node)) = cutter.material.rest[row(home)];
    mesh.node_held.edit(row(node)) = 0;
    for (const HeldRegion& region : cutter.setup.held) {
        if (holds(region, cutter.material.rest[row(home)], cutter.material.support[row(home)])) {
            mesh.node_held.edit(row(node)) = 1;
        }
    }
}

} // namespace resect
