// SPDX-License-Identifier: Apache-2.0
// One mesh, one knife, every way to cut.
#pragma once

#include <optional>
#include <string>

#include "lab/surface.hpp"

namespace lab {

/// A body that hangs by its held side, and the sheet of a knife that goes into it while it is at rest.
struct Problem {
    TetMesh mesh = {};
    Box bounds = {};
    double spacing = 0; // m, of its cells
    resect::Material material = {};
    Box held = {};
    Vec3 gravity = {};
    Sheet sheet;
    std::array<Vec3, 2> gauge = {}; // two points of the skin on the two sides of the mouth, m
};

/// [node] m.
std::vector<Vec3> displacement_of(const resect::Simulation& simulation);

struct Notch {
    double depth = 0.05; // m, along z
    double lean = 0;     // m by which the tip lies nearer to the held side than the mouth
    double jitter = 0.2; // cells by which nodes of the mesh are moved at most
    unsigned seed = 1;   // of that
    double finest = 1;   // width of cells about the tip, as a share of even ones
};

/// Of the block below, `cells` along its longer edges.
std::array<Index, 3> block_cells(Index cells);
/// A block of 0.10 x 0.08 x 0.10 m that hangs by x = 0 and is notched at x = 0.05, from z = 0.10 down.
/// Without jitter the sheet lies on faces of a mesh of even cells.
Problem hang_block(const std::array<Index, 3>& cells, const Notch& notch = {});
/// The same block, stiffer and lying, with a knife that goes flat at z = 0.025 from the free end into the
/// held side. Without jitter the sheet lies on faces of a mesh of 4, 8, 12 ... cells along z.
Problem split_into_wall(const std::array<Index, 3>& cells, double jitter = 0, unsigned seed = 1);
/// The first with a knife that leans and goes along an arc.
Problem bow(Problem problem);

/// What a method made of a problem. What does not apply is nothing.
struct Outcome {
    std::string method = {}, source = {};
    std::optional<CutSurface> surface = {};
    Index unknowns = 0;
    double volume_lost = 0, mass_error = 0; // shares
    double roughness = 0;                   // m
    std::optional<double> opening = {};     // m
    double cut_ms = 0;                      // topology, and what the method updates
    double step_ms = 0;                     // one step, or one solution
    double step = 0;                        // s, that is stable; 0: solved at once
    std::string remark = {};
    /// A step takes no longer than it simulates, a solution no longer than a frame at 25 Hz, and the cut no
    /// longer than a stroke of a second.
    bool is_real_time() const { return step_ms < (step > 0 ? 1e3 * step : 40) && cut_ms < 1000; }
};

Outcome cut_by_virtual_nodes(const Problem& problem, const resect::CutOptions& options = {});
Outcome cut_by_removal(const Problem& problem);
Outcome cut_along_faces(const Problem& problem, bool moves_nodes);
/// The material of our own cut, simulated itself in place of the elements around it.
Outcome cut_by_subdivision(const Problem& problem, bool moves_nodes);
Outcome cut_along_faces_linear(const Problem& problem);
/// Precomputed inverse, updated tet by tet.
Outcome cut_by_woodbury(const Problem& problem);
Outcome cut_by_tensor_mass(const Problem& problem);

/// The opening that CalculiX finds on the mesh of a problem, whose sheet lies on faces and ends at nodes,
/// split where the sheet is, m.
std::optional<double> find_reference_opening(const Problem& problem, bool quadratic,
                                             const std::string& folder);

} // namespace lab
