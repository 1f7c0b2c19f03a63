// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "bench/matrix.hpp"

using namespace resect;

// A part of the matrix that `resect bench matrix` runs whole (docs/method.md, "Cuts through soft bodies").
TEST_CASE("soft blocks that are cut while they swing come to rest with no element inverted") {
    for (const bench::Cuts cuts :
         {bench::Cuts::half, bench::Cuts::full, bench::Cuts::crossing, bench::Cuts::random}) {
        for (const double load_number : {0.05, 0.2, 0.4}) {
            const bench::MatrixRow row = bench::run_cell(
                {.tissue = bench::Tissue::block, .cuts = cuts, .load_number = load_number, .seed = 1},
                {.steps_after = 3000, .block_cells = 4});
            INFO(bench::name(cuts) << " cuts, load number " << load_number << ": " << row.reason);
            CHECK(row.status == Status::ok);
            CHECK(row.elements_cut > 20);
            CHECK(row.inverted_end == 0);
        }
    }
}

TEST_CASE("a soft liver that is cut while it swings comes to rest with no element inverted") {
    for (const bench::Cuts cuts : {bench::Cuts::half, bench::Cuts::full, bench::Cuts::crossing}) {
        for (const double load_number : {0.2, 0.4}) {
            const bench::MatrixRow row = bench::run_cell(
                {.tissue = bench::Tissue::liver, .cuts = cuts, .load_number = load_number, .seed = 1},
                {.steps_after = 2000, .liver_elements = 1500});
            INFO(bench::name(cuts) << " cuts, load number " << load_number << ": " << row.reason);
            CHECK(row.status == Status::ok);
            CHECK(row.elements_cut > 20);
            CHECK(row.inverted_end == 0);
        }
    }
}
