// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "base/index.hpp"
#include "base/vec.hpp"
#include "mesh/tet.hpp"

namespace resect {

/// Where a vertex sits in the elements: weights over element nodes that sum to one. Zeros are left out, so
/// the support names the corner, edge, face or element that holds the vertex.
struct Support {
    std::array<Index, 4> node = {-1, -1, -1, -1}; // -1: no more
    std::array<double, 4> weight = {};
};

/// The corner of a tet that is `node`, or 4.
inline std::size_t corner_of(const Tet& tet, Index node) {
    std::size_t corner = 0;
    while (corner < 4 && tet[corner] != node) {
        ++corner;
    }
    return corner;
}

inline double weight_of(const Support& support, Index node) {
    const std::size_t at = corner_of(support.node, node);
    return at < 4 ? support.weight[at] : 0;
}

/// (1 - t) a + t b; the two must lie in one element.
Support interpolate(const Support& a, const Support& b, double t);

/// Of a point inside an element (corners p), weights within `tolerance` of zero being zero; all nodes are -1
/// if the point lies outside.
Support find_support(const Tet& element, const std::array<Vec3, 4>& p, const Vec3& point, double tolerance);

/// Same nodes, in any order, and weights that differ by at most `tolerance`.
bool is_same(const Support& a, const Support& b, double tolerance);

} // namespace resect
