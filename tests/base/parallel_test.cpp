// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <doctest/doctest.h>
#include <numeric>
#include <vector>

#include "base/parallel.hpp"

using namespace resect;

TEST_CASE("every chunk is done exactly once for any number of threads") {
    for (const int threads : {1, 2, 3, 8}) {
        Workers workers(threads);
        CHECK(workers.threads() == threads);
        for (const Index count : {0, 1, 2, 7, 1000}) {
            std::vector<int> done(static_cast<std::size_t>(count), 0);
            workers.run(count, [&](Index chunk) { ++done[static_cast<std::size_t>(chunk)]; });
            CHECK(std::accumulate(done.begin(), done.end(), 0) == count);
            CHECK(std::count(done.begin(), done.end(), 1) == count);
        }
    }
}

TEST_CASE("what chunks wrote is seen after the run, job after job") {
    Workers workers(3);
    std::vector<long> values(64, 0);
    for (int job = 0; job < 5000; ++job) {
        workers.run(64, [&](Index chunk) { ++values[static_cast<std::size_t>(chunk)]; });
        if (values[static_cast<std::size_t>(job % 64)] != job + 1) {
            CHECK(values[static_cast<std::size_t>(job % 64)] == job + 1);
        }
    }
    CHECK(std::count(values.begin(), values.end(), 5000) == 64);
}

TEST_CASE("workers without a job come and go") {
    for (int i = 0; i < 50; ++i) {
        CHECK(Workers(4).threads() == 4);
    }
}

TEST_CASE("chunks tile a range") {
    Index covered = 0;
    for (Index chunk = 0; chunk < chunk_count(16, 100); ++chunk) {
        const auto [begin, end] = chunk_range(chunk, 16, 100);
        CHECK(begin == covered);
        covered = end;
    }
    CHECK(covered == 100);
}
