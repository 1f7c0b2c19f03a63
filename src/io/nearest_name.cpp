// SPDX-License-Identifier: Apache-2.0
#include "io/nearest_name.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace resect {

namespace {

/// Insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`; three rows of the
/// table are alive at a time.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), current(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) {
        last[j] = j;
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        current[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            current[j] = std::min({last[j] + 1, current[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                current[j] = std::min(current[j], before_last[j - 2] + 1);
            }
        }
        std::swap(before_last, last);
        std::swap(last, current);
    }
    return last[b.size()];
}

} // namespace

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
    constexpr std::size_t longest = 100; // of a key worth guessing at
    if (name.size() > longest) { return {}; }
    std::string nearest;
    std::size_t fewest = (std::max<std::size_t>(name.size(), 2) + 1) / 2 + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t mistakes = edit_distance(name, candidate);
        if (mistakes < fewest) {
            fewest = mistakes;
            nearest = candidate;
        }
    }
    return nearest;
}

} // namespace resect
