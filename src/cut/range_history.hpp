// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "resect/reports.hpp"

#include "base/index.hpp"

namespace resect {

/// Which rows of an array changed in its latest revisions, for mirrors of it to follow.
class RangeHistory {
public:
    /// All rows are new as of `revision`; earlier ones are forgotten.
    void restart(std::uint64_t revision);

    /// `rows` (any order, repeats allowed; sorted here) changed with `revision`, which is later than the
    /// last.
    void add(std::uint64_t revision, std::vector<Index>& rows);

    /// Few ranges that cover what changed after `revision`, within an array of `count` rows: all of it where
    /// the history does not go back so far. Valid until the next call.
    std::span<const Range> since(std::uint64_t revision, Index count);

private:
    struct Entry {
        std::uint64_t revision = 0;
        std::vector<Range> ranges = {};
    };
    std::uint64_t complete_since_ = 0; // what changed after this is in the entries
    std::uint64_t latest_ = 0;
    std::vector<Entry> entries_ = {}; // oldest first
    std::vector<Range> answer_ = {};
};

} // namespace resect
