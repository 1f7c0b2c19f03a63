// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scene_run.hpp"

namespace cli {

/// What was true before the first step.
struct InitialFigures {
    double mass = 0;   // kg, of the material at creation
    double volume = 0; // m^3
    resect::Index elements = 0, nodes = 0;
};
InitialFigures measure_initial(const resect::Body& body, const std::vector<resect::Material>& materials);

/// The JSON object of `resect run --json` (docs/manual.md).
std::string report_json(const std::string& scene, int threads, const InitialFigures& initial, SceneRun& run);

/// Writes text to a file, or to standard output where the path is "-".
resect::Result<void> write_text(const std::string& path, const std::string& text);

} // namespace cli
