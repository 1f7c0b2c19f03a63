// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <doctest/doctest.h>
#include <filesystem>

#include "fuzz/run.hpp"

using namespace resect;

namespace {

std::vector<std::string> list_cases(const char* folder) {
    std::vector<std::string> paths;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".json") { paths.push_back(entry.path().string()); }
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

void replay(const char* folder) {
    for (const std::string& path : list_cases(folder)) {
        const fuzz::Case read = must(fuzz::read_case(path));
        const fuzz::Verdict verdict = fuzz::run_case(read);
        const std::string fault = verdict.faults.empty() ? "" : verdict.faults.front();
        CHECK_MESSAGE(fault == "", path << " (" << read.what << "): " << fault);
    }
}

} // namespace

TEST_CASE("hard cases made by hand, and cases that failed once, hold") {
    replay(RESECT_SOURCE_FOLDER "/tests/corpus");
}

TEST_CASE("strokes that cross themselves cut what they enclose free") {
    replay(RESECT_SOURCE_FOLDER "/tests/corpus/loops");
}
