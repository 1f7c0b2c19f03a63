// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "resect/resect.hpp"

#include "lab/mesh_cuts.hpp"

namespace lab {

/// The boundary of a body that any method has cut, and how it lies now.
struct CutSurface {
    std::vector<Vec3> rest = {}, now = {}; // [vertex] m
    std::vector<std::array<Index, 3>> triangles = {};
    std::vector<Index> is_cut = {}; // [triangle] 1: the cut made it
};

CutSurface surface_of(resect::Simulation& simulation);
/// Of a mesh whose nodes come from those of `before`: what was not on its boundary is cut.
CutSurface surface_of(const CutMesh& cut, const TetMesh& before, const std::vector<Vec3>& displacement);
/// Of the material of a simulation that was cut, simulated itself: `cut` is the material.
CutSurface surface_of(resect::Simulation& simulation, const CutMesh& cut,
                      const std::vector<Vec3>& displacement);

resect::Result<void> write_surface_file(const std::string& path, const CutSurface& surface);

/// Root mean square over the cut triangles of the distance of their centroids to the sheet at rest, m.
double measure_roughness(const CutSurface& surface, const Sheet& sheet);

/// How much farther apart two points of the skin lie than at rest, m: the displacement at the nearest points
/// of the uncut surface.
double measure_gauge(const CutSurface& surface, const Vec3& a, const Vec3& b);

} // namespace lab
