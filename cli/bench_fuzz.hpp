// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "options.hpp"

namespace cli {

/// Draws and runs cutting cases of all kinds until the minutes are over: sweeps that must leave two pieces,
/// planes that must leave as many as they have cells, strokes through bodies that move. Cases that fail are
/// left as files in the output folder, and counted in `failures`.
nlohmann::ordered_json bench_fuzz(const BenchOptions& options, bool talk, long& failures);

} // namespace cli
