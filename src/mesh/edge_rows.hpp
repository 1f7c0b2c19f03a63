// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/index.hpp"

namespace resect {

/// An edge as one number, the same from both ends.
inline std::uint64_t edge_key(Index a, Index b) {
    const auto [low, high] = std::minmax(a, b);
    return std::uint64_t{static_cast<std::uint32_t>(low)} << 32 | static_cast<std::uint32_t>(high);
}

/// A row for each edge named so far, in one flat table with linear probing.
class EdgeRows {
public:
    /// The edge's row, or null where it has none.
    const Index* find(std::uint64_t key) const {
        const std::size_t at = slot_of(key);
        return keys_[at] == key ? &rows_[at] : nullptr;
    }

    /// The edge's row, entered as -1 where it had none; holds until the next entry.
    Index& operator[](std::uint64_t key) {
        if (2 * size_ >= keys_.size()) { grow(); }
        const std::size_t at = slot_of(key);
        if (keys_[at] != key) {
            keys_[at] = key;
            ++size_;
        }
        return rows_[at];
    }

private:
    static constexpr std::uint64_t vacant = ~std::uint64_t{0};

    std::size_t slot_of(std::uint64_t key) const {
        std::uint64_t hash = (key ^ key >> 31) * 0x9E3779B97F4A7C15u;
        hash = (hash ^ hash >> 29) * 0xBF58476D1CE4E5B9u;
        std::size_t at = (hash ^ hash >> 32) & (keys_.size() - 1);
        while (keys_[at] != key && keys_[at] != vacant) {
            at = (at + 1) & (keys_.size() - 1);
        }
        return at;
    }

    void grow() {
        const std::vector<std::uint64_t> keys = std::exchange(keys_, {});
        const std::vector<Index> rows = std::exchange(rows_, {});
        keys_.assign(2 * keys.size(), vacant);
        rows_.assign(2 * keys.size(), -1);
        for (std::size_t old = 0; old < keys.size(); ++old) {
            if (keys[old] == vacant) { continue; }
            const std::size_t at = slot_of(keys[old]);
            keys_[at] = keys[old];
            rows_[at] = rows[old];
        }
    }

    std::vector<std::uint64_t> keys_ = std::vector<std::uint64_t>(1024, vacant); // a power of two
    std::vector<Index> rows_ = std::vector<Index>(1024, -1);
    std::size_t size_ = 0;
};

} // namespace resect
