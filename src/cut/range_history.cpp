// SPDX-License-Identifier: Apache-2.0
#include "cut/range_history.hpp"

#include <algorithm>

namespace resect {
namespace {

constexpr std::size_t most_entries = 64;
constexpr std::size_t most_ranges =
    16; // beyond these a copy of some rows more costs less than one range more

/// Joins ranges (by begin) whose gap is at most `gap`.
void close_gaps(std::vector<Range>& ranges, Index gap) {
    std::size_t last = 0;
    for (std::size_t i = 1; i < ranges.size(); ++i) {
        if (ranges[i].begin - ranges[last].end <= gap) {
            ranges[last].end = std::max(ranges[last].end, ranges[i].end);
        } else {
            ranges[++last] = ranges[i];
        }
    }
    ranges.resize(std::min(ranges.size(), last + 1));
}

/// Sorts and joins; closes the smallest gaps until few ranges are left.
void shorten(std::vector<Range>& ranges) {
    std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
    close_gaps(ranges, 0);
    if (ranges.size() <= most_ranges) { return; }
    std::vector<Index> gaps;
    gaps.reserve(ranges.size());
    for (std::size_t i = 1; i < ranges.size(); ++i) {
        gaps.push_back(ranges[i].begin - ranges[i - 1].end);
    }
    const auto widest_closed = gaps.begin() + static_cast<std::ptrdiff_t>(ranges.size() - most_ranges - 1);
    std::nth_element(gaps.begin(), widest_closed, gaps.end());
    close_gaps(ranges, *widest_closed);
}

} // namespace

void RangeHistory::restart(std::uint64_t revision) {
    complete_since_ = latest_ = revision;
    entries_.clear();
}

void RangeHistory::add(std::uint64_t revision, std::vector<Index>& rows) {
    latest_ = revision;
    if (entries_.size() < most_entries) {
        entries_.emplace_back();
    } else {
        complete_since_ = entries_.front().revision;
        std::rotate(entries_.begin(), entries_.begin() + 1, entries_.end());
    }
    Entry& entry = entries_.back();
    entry.revision = revision;
    entry.ranges.clear();
    std::sort(rows.begin(), rows.end());
    for (const Index at : rows) {
        entry.ranges.push_back({at, at + 1});
    }
    shorten(entry.ranges);
}

std::span<const Range> RangeHistory::since(std::uint64_t revision, Index count) {
    answer_.clear();
    if (revision >= latest_) { return answer_; }
    if (revision < complete_since_) {
        answer_.push_back({0, count});
        return answer_;
    }
    for (const Entry& entry : entries_) {
        if (entry.revision <= revision) { continue; }
        for (const Range& range : entry.ranges) {
            if (range.begin < count) { answer_.push_back({range.begin, std::min(range.end, count)}); }
        }
    }
    shorten(answer_);
    return answer_;
}

} // namespace resect
