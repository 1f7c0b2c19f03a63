// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "resect/result.hpp"

namespace cli {

/// The step rate of `resect serve` with and without fifty clients that send rubbish, in turn,
/// with time to spare and at the limit of one thread.
resect::Result<nlohmann::ordered_json> bench_soak(bool talk);

} // namespace cli
