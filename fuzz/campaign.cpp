// SPDX-License-Identifier: Apache-2.0
#include "campaign.hpp"

#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>

#include "draw.hpp"

namespace resect::fuzz {

Campaign::Campaign(Family family, std::uint64_t base, std::string folder)
    : family_(family), base_(base), folder_(std::move(folder)) {}

void Campaign::run_next(Index most_strokes) {
    const std::uint64_t seed = derive_seed(base_, static_cast<std::uint64_t>(family_), next_++);
    const std::string file = fmt::format("{}/{}_{:016x}.json", folder_, name_of(family_), seed);
    Verdict verdict;
    if (family_ == Family::strokes) {
        Case drawn = draw_moving_body(seed);
        verdict = run_strokes_through_body(drawn, file, most_strokes);
    } else {
        const Case drawn = family_ == Family::sweeps ? draw_sweep(seed) : draw_planes(seed);
        write_case(file, drawn);
        verdict = run_case(drawn);
    }
    add(counts_, verdict.counts);
    if (verdict.faults.empty()) {
        std::filesystem::remove(file);
    } else {
        failures_.push_back({seed, verdict.faults.front(), file});
    }
}

Verdict Campaign::run_strokes_through_body(Case& drawn, const std::string& file, Index most_strokes) {
    Random random(derive_seed(drawn.seed, 0, 0));
    return run_strokes(drawn, [&](Case& so_far, Simulation& simulation) {
        if (so_far.strokes.size() >= row(most_strokes)) { return false; }
        so_far.strokes.push_back(draw_stroke(random, simulation));
        write_case(file, so_far);
        return true;
    });
}

const char* name_of(Family family) {
    switch (family) {
    case Family::sweeps:
        return "sweep";
    case Family::planes:
        return "planes";
    case Family::strokes:
        return "strokes";
    }
    return "";
}

std::uint64_t base_seed() {
    constexpr std::uint64_t fixed = 20051;
    const char* told = std::getenv("RESECT_SEED");
    return told == nullptr ? fixed : std::strtoull(told, nullptr, 10);
}

} // namespace resect::fuzz
