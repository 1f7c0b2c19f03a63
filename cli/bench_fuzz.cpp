// SPDX-License-Identifier: Apache-2.0
#include "bench_fuzz.hpp"

#include <array>
#include <fmt/format.h>

#include "fuzz/campaign.hpp"
#include "progress.hpp"
#include "samples.hpp"

namespace cli {

namespace {

using namespace resect;
using Json = nlohmann::ordered_json;

constexpr std::array<fuzz::Family, 3> families = {fuzz::Family::sweeps, fuzz::Family::planes,
                                                  fuzz::Family::strokes};

Json summary(const fuzz::Campaign& campaign) {
    const fuzz::Counts& counts = campaign.counts();
    Json failed = Json::array();
    for (const fuzz::Failure& failure : campaign.failures()) {
        failed.push_back({{"seed", failure.seed}, {"fault", failure.fault}, {"file", failure.file}});
    }
    return {{"cases", counts.cases},
            {"strokes", counts.strokes},
            {"strokes_with_copy", counts.strokes_with_copy},
            {"crossings", counts.crossings},
            {"bisections", counts.bisections},
            {"torn_faces", counts.torn_faces},
            {"copies", counts.copies},
            {"refused", counts.refused},
            {"failures", failed}};
}

} // namespace

Json bench_fuzz(const BenchOptions& options, bool talk, long& failures) {
    std::vector<fuzz::Campaign> campaigns;
    campaigns.reserve(families.size());
    for (const fuzz::Family family : families) {
        campaigns.emplace_back(family, options.seed, options.out);
    }
    Progress progress;
    Timer timer;
    double passed = 0;
    while (passed < 60 * options.minutes) {
        for (fuzz::Campaign& campaign : campaigns) {
            campaign.run_next();
        }
        progress.show(fmt::format("fuzz: {} sweeps, {} plane cuts, {} strokes, {:.1f} of {:g} minutes",
                                  campaigns[0].counts().cases, campaigns[1].counts().cases,
                                  campaigns[2].counts().strokes, passed / 60, options.minutes));
        passed += timer.lap();
    }
    progress.clear();
    Json json;
    for (std::size_t i = 0; i < families.size(); ++i) {
        json[fuzz::name_of(families[i])] = summary(campaigns[i]);
        failures += static_cast<long>(campaigns[i].failures().size());
        if (talk) {
            fmt::print("fuzz  {:8} {}\n", fuzz::name_of(families[i]), fuzz::describe(campaigns[i].counts()));
        }
    }
    return json;
}

} // namespace cli
