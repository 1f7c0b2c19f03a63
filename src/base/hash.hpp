// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

namespace resect {

/// A running 64-bit hash of bytes: the same on every machine of one endianness, and the same for equal bits
/// only.
class Hash {
public:
    template <class T>
    Hash& add(std::span<const T> values) {
        for (const T& value : values) {
            add(value);
        }
        return *this;
    }
    template <class T>
    Hash& add(const T& value) {
        unsigned char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        std::size_t at = 0;
        for (; at + 8 <= sizeof(T); at += 8) {
            mix(word(bytes + at, 8));
        }
        if (at < sizeof(T)) { mix(word(bytes + at, sizeof(T) - at)); }
        return *this;
    }
    std::uint64_t value() const { return state_ ^ (state_ >> 29); }

private:
    static std::uint64_t word(const unsigned char* bytes, std::size_t count) {
        std::uint64_t w = 0;
        std::memcpy(&w, bytes, count);
        return w;
    }
    void mix(std::uint64_t w) {
        state_ ^= w * 0x9E3779B97F4A7C15U;
        state_ = ((state_ << 27) | (state_ >> 37)) * 0xD6E8FEB86659FD93U;
    }
    std::uint64_t state_ = 0x243F6A8885A308D3U;
};

} // namespace resect
