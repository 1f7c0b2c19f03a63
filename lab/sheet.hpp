// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "resect/commands.hpp"

namespace lab {

using resect::Box;
using resect::Edge;
using resect::Index;
using resect::TetMesh;
using resect::Vec3;

/// The surface that a straight edge sweeps over while it goes from pose to pose, as triangles.
class Sheet {
public:
    explicit Sheet(std::vector<Edge> poses);

    const std::vector<Edge>& poses() const { return poses_; }
    /// Whether the segment from `a` to `b` goes through it.
    bool crosses(const Vec3& a, const Vec3& b) const;
    Vec3 nearest(const Vec3& p) const;
    double distance(const Vec3& p) const;

private:
    std::vector<Edge> poses_ = {};
    std::vector<std::array<Vec3, 3>> triangles_ = {};
};

/// A flat notch across y through a block: from `mouth` as deep as `tip`, for all y of the block.
Sheet flat_notch(const Vec3& mouth, const Vec3& tip, double width);

} // namespace lab
