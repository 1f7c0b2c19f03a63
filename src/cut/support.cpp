// SPDX-License-Identifier: Apache-2.0
#include "cut/support.hpp"

#include <cmath>

#include "base/assert.hpp"

namespace resect {
namespace {

void add(Support& sum, Index node, double weight) {
    if (node < 0 || weight == 0) { return; }
    std::size_t at = corner_of(sum.node, node);
    if (at == 4) { at = corner_of(sum.node, -1); }
    RESECT_ASSERT(at < 4);
    sum.node[at] = node;
    sum.weight[at] += weight;
}

} // namespace

Support interpolate(const Support& a, const Support& b, double t) {
    Support sum;
    for (std::size_t i = 0; i < 4; ++i) {
        add(sum, a.node[i], (1 - t) * a.weight[i]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
        add(sum, b.node[i], t * b.weight[i]);
    }
    return sum;
}

Support find_support(const Tet& element, const std::array<Vec3, 4>& p, const Vec3& point, double tolerance) {
    const double volume = signed_volume(p[0], p[1], p[2], p[3]);
    std::array<double, 4> weight = {};
    double sum = 0;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        std::array<Vec3, 4> q = p;
        q[corner] = point;
        weight[corner] = signed_volume(q[0], q[1], q[2], q[3]) / volume;
        if (std::abs(weight[corner]) <= tolerance) { weight[corner] = 0; }
        if (!(weight[corner] >= 0)) { return {}; }
        sum += weight[corner];
    }
    Support support;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        add(support, element[corner], weight[corner] / sum);
    }
    return support;
}

bool is_same(const Support& a, const Support& b, double tolerance) {
    for (std::size_t i = 0; i < 4; ++i) {
        if (a.node[i] >= 0 && !(std::abs(a.weight[i] - weight_of(b, a.node[i])) <= tolerance)) {
            return false;
        }
        if (a.node[i] >= 0 && corner_of(b.node, a.node[i]) == 4) { return false; }
        if (b.node[i] >= 0 && corner_of(a.node, b.node[i]) == 4) { return false; }
    }
    return true;
}

} // namespace resect
