// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

// What a core of this machine can do at most, for figures to stand beside.
namespace bench {

/// Floating-point operations a second of one thread, single precision, by fused multiply-adds where the
/// instruction set has them (two operations each).
double measure_flops(const std::string& instruction_set);
/// Bytes a second that one thread reads from memory.
double measure_read_bandwidth();

} // namespace bench
