// SPDX-License-Identifier: Apache-2.0
#include "io/base64.hpp"

#include <cstdint>

namespace resect {

namespace {

constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

} // namespace

std::optional<std::string> decode_base64(std::string_view text, std::size_t enough) {
    std::string bytes;
    std::uint32_t group = 0;
    int count = 0, padding = 0;
    for (const char c : text) {
        if (is_blank(c)) { continue; }
        const std::size_t value = c == '=' ? 0 : letters.find(c);
        if (value == std::string_view::npos) { return std::nullopt; }
        group = group << 6U | static_cast<std::uint32_t>(value);
        padding += c == '=' ? 1 : 0;
        if (++count < 4) { continue; }
        for (int byte = 2; byte >= padding; --byte) {
            bytes += static_cast<char>(group >> static_cast<unsigned>(8 * byte) & 0xFFU);
        }
        group = 0;
        count = padding = 0;
        if (bytes.size() >= enough) { return bytes; }
    }
    return bytes;
}

} // namespace resect
