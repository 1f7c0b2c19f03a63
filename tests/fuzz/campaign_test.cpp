// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "fuzz/campaign.hpp"

using namespace resect;

namespace {

/// RESECT_FUZZ_SHARE makes fewer of them, for builds that are slow.
Index share_of(Index cases) {
    const char* told = std::getenv("RESECT_FUZZ_SHARE");
    const double share = told == nullptr ? 1 : std::strtod(told, nullptr);
    return std::max(1, static_cast<Index>(share * cases));
}

void report(const fuzz::Campaign& campaign, const char* name) {
    MESSAGE(fmt::format("{}: {}", name, fuzz::describe(campaign.counts())));
    for (const fuzz::Failure& failure : campaign.failures()) {
        FAIL_CHECK(fmt::format("seed {}: {} ({})", failure.seed, failure.fault, failure.file));
    }
    CHECK(campaign.failures().empty());
}

const char* const folder = "fuzz_cases"; // in ctest's working directory

} // namespace

TEST_CASE("a curved sweep of a turning blade through waving tissue leaves two pieces") {
    fuzz::Campaign campaign(fuzz::Family::sweeps, fuzz::base_seed(), folder);
    while (campaign.counts().cases < share_of(200)) {
        campaign.run_next();
    }
    report(campaign, "sweeps");
}

TEST_CASE("planes cut a block into as many pieces as they have sign vectors") {
    fuzz::Campaign campaign(fuzz::Family::planes, fuzz::base_seed(), folder);
    while (campaign.counts().cases < share_of(100)) {
        campaign.run_next();
    }
    report(campaign, "planes");
}

TEST_CASE("random strokes through bodies that move break nothing, and most of them cut") {
    fuzz::Campaign campaign(fuzz::Family::strokes, fuzz::base_seed(), folder);
    while (campaign.counts().strokes < share_of(200)) {
        campaign.run_next();
    }
    report(campaign, "strokes");
    CHECK(campaign.counts().strokes_with_copy >= 0.6 * campaign.counts().strokes);
}
