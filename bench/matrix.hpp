// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "resect/resect.hpp"

// The stability matrix (docs/method.md, "What was tried"): soft bodies that hang from one side and are cut
// while they swing, then left alone for many steps.
namespace bench {

/// A jittered Kuhn cube of 0.1 m, its left side held; or the liver, its right lobe held.
enum class Tissue { block, liver };
/// All cuts are straight sweeps through tissue that gravity, at once and in full, has just set swinging.
/// Half: across, until half the section's area is torn. Full: across, and on until nothing held hangs below
/// the blade. Crossing: three full cuts through one point, one lengthwise, two across. Random: 20 strokes of
/// finite blades.
enum class Cuts { half, full, crossing, random };

struct MatrixCell {
    Tissue tissue = Tissue::block;
    Cuts cuts = Cuts::full;
    double load_number = 0.05; // rho g L / E, L the reach of the body from where it is held
    unsigned seed = 1;         // of the block's jitter and of the blades' poses
};

struct MatrixSize {
    std::int64_t steps_after = 20000; // of the last cut
    resect::Index block_cells = 6;    // an edge
    resect::Index liver_elements = 6097;
};

struct MatrixRow {
    MatrixCell cell = {};
    double young = 0;  // Pa
    double length = 0; // m, L
    resect::Index elements = 0, elements_cut = 0, pieces = 0;
    std::int64_t steps = 0; // cutting and after
    resect::Status status = resect::Status::ok;
    std::string reason = {};
    resect::Index inverted_end = 0, inverted_most = 0; // element copies, at checks every 50 steps
    double stretch_min = 1, stretch_max = 1;           // at any of those checks
    double speed_end = 0;                              // m/s, fastest node of held pieces at the end
};

const char* name(Tissue tissue);
const char* name(Cuts cuts);

/// All cells, by tissue, cuts, load number (0.05, 0.2, 0.4) and seed (1, 2, ...).
std::vector<MatrixCell> list_cells(unsigned seeds);

/// Runs a cell at the default step, with damping 2 /s, on one thread.
MatrixRow run_cell(const MatrixCell& cell, const MatrixSize& size);

} // namespace bench
