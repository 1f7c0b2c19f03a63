// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>

#include "bench_cut.hpp"
#include "bench_fuzz.hpp"
#include "bench_matrix.hpp"
#include "bench_realtime.hpp"
#include "bench_soak.hpp"
#include "bench_step.hpp"
#include "options.hpp"
#include "report.hpp"

namespace cli {

namespace {

using namespace resect;
using Json = nlohmann::ordered_json;

} // namespace

int bench(const BenchOptions& options) {
    constexpr std::array known = {"step", "cut", "realtime", "matrix", "fuzz", "soak"};
    for (const std::string& name : options.names) {
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            return refuse(
                fmt::format("bench: '{}' is not known; give one of {}", name, fmt::join(known, ", ")));
        }
    }
    const auto named = [&](const char* name) {
        return std::find(options.names.begin(), options.names.end(), name) != options.names.end();
    };
    const auto wanted = [&](const char* name) { return options.names.empty() || named(name); };
    Json json;
    json["resect_version"] = version;
    json["isa"] = instruction_set();
    const bool talk = options.json != "-";
    if (wanted("step")) { json["step"] = bench_step(options, talk); }
    if (wanted("cut")) { json["cut"] = bench_cut(talk); }
    if (named("realtime")) { json["realtime"] = bench_realtime(options.threads, talk); }
    if (named("matrix")) { json["matrix"] = bench_matrix(options.seeds, std::max(options.threads, 1), talk); }
    if (named("soak")) {
        const Result<Json> soak = bench_soak(talk);
        if (!soak) { return refuse(soak.error().message); }
        json["soak"] = *soak;
    }
    long failures = 0;
    if (named("fuzz")) { json["fuzz"] = bench_fuzz(options, talk, failures); }
    const int status = failures == 0 ? done : failed;
    if (options.json.empty()) { return status; }
    const Result<void> written = write_text(options.json, json.dump(2) + "\n");
    return written ? status : refuse(written.error().message);
}

} // namespace cli
