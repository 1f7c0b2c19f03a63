// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/index.hpp"

namespace resect {

/// Marks on rows, all taken back at once by clear().
class Marks {
public:
    void grow(std::size_t rows) {
        if (stamps_.size() < rows) { stamps_.resize(rows + rows / 2, 0); }
    }

    void clear(std::size_t rows) {
        grow(rows);
        if (++stamp_ == 0) {
            std::fill(stamps_.begin(), stamps_.end(), 0);
            stamp_ = 1;
        }
    }

    bool has(Index at) const { return stamps_[row(at)] == stamp_; }

    /// True if the row had no mark yet.
    bool set(Index at) {
        if (has(at)) { return false; }
        stamps_[row(at)] = stamp_;
        return true;
    }

private:
    std::vector<std::uint32_t> stamps_ = {};
    std::uint32_t stamp_ = 0;
};

} // namespace resect
