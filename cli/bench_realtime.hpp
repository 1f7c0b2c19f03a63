// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace cli {

/// Livers settled under their own weight, larger and larger while they keep up with the clock.
nlohmann::ordered_json bench_realtime(int threads, bool talk);

} // namespace cli
