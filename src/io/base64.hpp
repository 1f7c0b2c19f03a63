// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace resect {

/// At least `enough` bytes from the front of base64 text, if it holds so many: whole groups of four letters.
/// A padded group may be followed by more groups, since some writers encode a header by itself. Nothing where
/// a letter is none of base64.
std::optional<std::string> decode_base64(std::string_view text, std::size_t enough);

} // namespace resect
