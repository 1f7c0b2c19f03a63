// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
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
    std::uint32_t stamp_ = 1;
};

/// Rows in the order in which they were added, each once.
class RowSet {
public:
    void add(Index at) {
        marks_.grow(row(at) + 1);
        if (marks_.set(at)) { rows_.push_back(at); }
    }

    void clear() {
        marks_.clear(0);
        rows_.clear();
    }

    std::span<const Index> rows() const { return rows_; }

private:
    Marks marks_ = {};
    std::vector<Index> rows_ = {};
};

} // namespace resect
