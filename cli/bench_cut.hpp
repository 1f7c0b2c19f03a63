// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace cli {

/// What cuts cost, in microseconds on one thread: the increments of a stroke through the liver, many elements
/// at once by each way to have their quantities, and one stroke in a small and in a large body. Prints lines
/// if it may `talk`.
nlohmann::ordered_json bench_cut(bool talk);
/// The paper's figure 4: many elements at once, by each way to have the precomputed quantities; few sizes if
/// `quick`.
nlohmann::ordered_json bench_at_once(bool quick = false);

} // namespace cli
