// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace cli {

/// The stability matrix with this many seeds a cell, `threads` cells at a time: a table where `talk`, and
/// every run as JSON.
nlohmann::ordered_json bench_matrix(unsigned seeds, int threads, bool talk);

} // namespace cli
