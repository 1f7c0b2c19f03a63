// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace resect {

inline constexpr char version[] = "0.1.0";

} // namespace resect
