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

/// Whether all of a list have marks: asked again and again while marks only come, so that each is looked at
/// once.
template <class Item, class RowOf>
class AllMarked {
public:
    AllMarked(const Marks& marks, std::span<const Item> list, RowOf row_of)
        : marks_(marks), list_(list), row_of_(row_of) {}

    bool operator()() {
        while (marked_ < list_.size() && marks_.has(row_of_(list_[marked_]))) {
            ++marked_;
        }
        return marked_ == list_.size();
    }
    /// The first without, where there is one.
    const Item& next() const { return list_[marked_]; }

private:
    const Marks& marks_;
    std::span<const Item> list_;
    RowOf row_of_;
    std::size_t marked_ = 0;
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
