// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "fem/kernels.hpp"

namespace resect {

/// The kernels of an instruction set, "" the best; null: there are none, or this processor lacks it.
const Kernels* find_kernels(std::string_view name);
/// Those that this process steps with: the best, or what was chosen. All give the same bits.
const Kernels& kernels();
/// For the whole process, before any step. False: find_kernels finds none.
bool choose_kernels(std::string_view name);

} // namespace resect
