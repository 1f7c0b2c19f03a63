// SPDX-License-Identifier: Apache-2.0
// CalculiX as a judge: the same body, loaded statically, large strains, the same law.
#pragma once

#include <optional>
#include <string>

#include "resect/setup.hpp"

#include "lab/sheet.hpp"

namespace lab {

struct StaticProblem {
    TetMesh mesh = {};
    resect::Material material = {};
    Box held = {};
    Vec3 gravity = {};
    bool quadratic = false; // ten-node tets: mid-edge nodes are added, straight
};

/// [node of the mesh] m; nothing where CalculiX (ccx) is not installed or finds no solution. Writes into
/// `folder`.
std::optional<std::vector<Vec3>> solve_by_calculix(const StaticProblem& problem, const std::string& folder);

} // namespace lab
