// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace resect {

enum class NumberKind { real, signed_integer, unsigned_integer };

struct NumberType {
    NumberKind kind = NumberKind::real;
    std::size_t size = 8; // bytes
};

/// By a name of VTK, of its XML ("Float32") or legacy files ("unsigned_int").
std::optional<NumberType> find_number_type(std::string_view name);

/// Whole numbers that lie behind each other in `bytes`, which may end with a part of one.
std::vector<double> decode_reals(std::string_view bytes, NumberType type, bool big_endian);
/// The same of a type that is not real. Unsigned numbers above 2^63 come out negative.
std::vector<std::int64_t> decode_integers(std::string_view bytes, NumberType type, bool big_endian);

} // namespace resect
