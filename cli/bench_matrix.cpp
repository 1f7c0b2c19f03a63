// SPDX-License-Identifier: Apache-2.0
#include "bench_matrix.hpp"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>
#include <thread>
#include <vector>

#include "bench/matrix.hpp"
#include "progress.hpp"

namespace cli {

namespace {

using namespace resect;
using bench::MatrixCell;
using bench::MatrixRow;
using Json = nlohmann::ordered_json;

const char* name(Status status) { return status == Status::ok ? "ok" : "diverged"; }

std::vector<MatrixRow> run_cells(const std::vector<MatrixCell>& cells, int threads) {
    std::vector<MatrixRow> rows(cells.size());
    std::atomic<std::size_t> next = 0, done = 0;
    const auto work = [&](bool shows) {
        Progress progress;
        for (std::size_t i = next++; i < cells.size(); i = next++) {
            if (shows) { progress.show(fmt::format("matrix: {} of {} runs", done.load(), cells.size())); }
            rows[i] = bench::run_cell(cells[i], {});
            ++done;
        }
    };
    std::vector<std::thread> others;
    for (int thread = 1; thread < threads; ++thread) {
        others.emplace_back(work, false);
    }
    work(true);
    for (std::thread& other : others) {
        other.join();
    }
    return rows;
}

/// Runs of one cell that differ in their seed only.
bool is_same_cell(const MatrixRow& a, const MatrixRow& b) {
    return a.cell.tissue == b.cell.tissue && a.cell.cuts == b.cell.cuts &&
           a.cell.load_number == b.cell.load_number;
}

void print_cell(const std::vector<MatrixRow>& rows, std::size_t begin, std::size_t end) {
    MatrixRow worst = rows[begin];
    int dead = 0, cut = rows[begin].elements_cut;
    for (std::size_t i = begin; i < end; ++i) {
        const MatrixRow& row = rows[i];
        dead += row.status == Status::ok ? 0 : 1;
        cut = std::min(cut, row.elements_cut);
        worst.inverted_end = std::max(worst.inverted_end, row.inverted_end);
        worst.inverted_most = std::max(worst.inverted_most, row.inverted_most);
        worst.stretch_min = std::min(worst.stretch_min, row.stretch_min);
        worst.stretch_max = std::max(worst.stretch_max, row.stretch_max);
        worst.speed_end = std::max(worst.speed_end, row.speed_end);
    }
    fmt::print("{:6} {:8} {:5.2f} {:5} of {} {:8} {:9} {:9} {:9.3f} {:7.2f} {:10.1e}\n",
               bench::name(worst.cell.tissue), bench::name(worst.cell.cuts), worst.cell.load_number, dead,
               end - begin, cut, worst.inverted_end, worst.inverted_most, worst.stretch_min,
               worst.stretch_max, worst.speed_end);
}

void print_table(const std::vector<MatrixRow>& rows) {
    fmt::print("{:6} {:8} {:>5} {:>10} {:>8} {:>9} {:>9} {:>17} {:>10}\n", "", "", "", "", "cut,", "inverted",
               "inverted", "stretch", "speed at");
    fmt::print("{:6} {:8} {:>5} {:>10} {:>8} {:>9} {:>9} {:>9} {:>7} {:>10}\n", "body", "cuts", "load",
               "dead", "at least", "at end", "at most", "from", "to", "end, m/s");
    for (std::size_t begin = 0; begin < rows.size();) {
        std::size_t end = begin;
        while (end < rows.size() && is_same_cell(rows[begin], rows[end])) {
            ++end;
        }
        print_cell(rows, begin, end);
        begin = end;
    }
    for (const MatrixRow& row : rows) {
        if (row.status == Status::ok) { continue; }
        fmt::print("{} {} {} seed {}: {}\n", bench::name(row.cell.tissue), bench::name(row.cell.cuts),
                   row.cell.load_number, row.cell.seed, row.reason);
    }
}

} // namespace

nlohmann::ordered_json bench_matrix(unsigned seeds, int threads, bool talk) {
    const std::vector<MatrixRow> rows = run_cells(bench::list_cells(seeds), threads);
    if (talk) { print_table(rows); }
    Json json = Json::array();
    for (const MatrixRow& row : rows) {
        json.push_back({{"body", bench::name(row.cell.tissue)},
                        {"cuts", bench::name(row.cell.cuts)},
                        {"load_number", row.cell.load_number},
                        {"seed", row.cell.seed},
                        {"young", row.young},
                        {"length_m", row.length},
                        {"elements", row.elements},
                        {"elements_cut", row.elements_cut},
                        {"pieces", row.pieces},
                        {"steps", row.steps},
                        {"inverted_end", row.inverted_end},
                        {"inverted_most", row.inverted_most},
                        {"stretch_min", row.stretch_min},
                        {"stretch_max", row.stretch_max},
                        {"speed_end", row.speed_end},
                        {"status", name(row.status)},
                        {"reason", row.reason}});
    }
    return json;
}

} // namespace cli
