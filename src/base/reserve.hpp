// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace resect {

/// Makes room for `times` the present rows, and has the system hand over the memory for the first of the new
/// ones now, so that no step has to wait for it.
template <class T>
void reserve_ahead(std::vector<T>& rows, std::size_t times) {
    constexpr std::size_t bytes_at_once = std::size_t{1} << 25U;
    const std::size_t count = rows.size();
    rows.reserve(times * count);
    rows.resize(count + std::min((times - 1) * count, bytes_at_once / sizeof(T)));
    rows.resize(count);
}

} // namespace resect
