// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "run.hpp"

namespace resect::fuzz {

enum class Family { sweeps, planes, strokes };

/// A case that failed, and the file that holds it.
struct Failure {
    std::uint64_t seed = 0;
    std::string fault = {}, file = {};
};

/// Draws cases of one family and runs them. A case is in a file of `folder` while it runs and stays there if
/// it fails, by a crash too.
class Campaign {
public:
    Campaign(Family family, std::uint64_t base, std::string folder);

    /// Runs the next case; for strokes that is a body and up to `most_strokes` through it.
    void run_next(Index most_strokes = 5);

    const Counts& counts() const { return counts_; }
    const std::vector<Failure>& failures() const { return failures_; }

private:
    Verdict run_strokes_through_body(Case& drawn, const std::string& file, Index most_strokes);

    Family family_;
    std::uint64_t base_;
    std::string folder_;
    std::uint64_t next_ = 0;
    Counts counts_ = {};
    std::vector<Failure> failures_ = {};
};

const char* name_of(Family family);

/// Of the environment variable RESECT_SEED, or always the same.
std::uint64_t base_seed();

} // namespace resect::fuzz
