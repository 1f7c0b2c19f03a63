// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "options.hpp"

namespace cli {

/// Element updates a second over whole steps, by mesh, instruction set and number of threads, beside what the
/// machine could do.
nlohmann::ordered_json bench_step(const BenchOptions& options, bool talk);

} // namespace cli
