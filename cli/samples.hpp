// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <vector>

namespace cli {

/// Measurements of one kind.
class Samples {
public:
    void add(double value) { values_.push_back(value); }
    std::size_t count() const { return values_.size(); }
    double last() const { return values_.back(); }
    double sum() const {
        double total = 0;
        for (const double value : values_) {
            total += value;
        }
        return total;
    }
    /// The smallest value that `share` of the values do not exceed; 0 without any.
    double percentile(double share) const {
        if (values_.empty()) { return 0; }
        std::vector<double> sorted = values_;
        const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
        const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
        std::nth_element(sorted.begin(), at, sorted.end());
        return *at;
    }

private:
    std::vector<double> values_ = {};
};

/// Wall time since it was made or last read, s.
class Timer {
public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const std::chrono::duration<double> passed = now - last_;
        last_ = now;
        return passed.count();
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

} // namespace cli
