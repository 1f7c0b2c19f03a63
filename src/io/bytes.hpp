// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <span>
#include <string>
#include <type_traits>

namespace resect {

static_assert(std::endian::native == std::endian::little, "binary files are written as they lie in memory");

/// Adds the bytes of a number or of a struct of numbers without gaps.
template <class T>
void append_bytes(std::string& out, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
std::string bytes_of(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    return values.empty() ? std::string()
                          : std::string(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

} // namespace resect
