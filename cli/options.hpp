// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "resect/resect.hpp"

namespace cli {

/// Exit statuses, a contract: done; the physics or a check failed; the input or the command line was wrong.
inline constexpr int done = 0, failed = 1, refused = 2;

struct RunOptions {
    std::string scene = {};
    double seconds = -1; // below 0: the scene's duration
    std::string out = {};
    int threads = 0;
    std::vector<std::string> overrides = {};
    std::string isa = {};
    std::string json = {};
    std::string record = {}; // file to write
};

struct ReplayOptions {
    std::string record = {};
    bool check_hash = false;
    int threads = 0;
    std::string isa = {};
    std::string surface = {}; // file to write
};

struct ServeOptions {
    std::string scene = {};
    std::string address = "127.0.0.1";
    int port = 8080;
    std::vector<std::string> names = {};
    int threads = 0; // 0: half of the cores
    std::string isa = {};
    std::string out = "out";
    bool open = false; // a browser, where there is a screen
};

struct MeshOptions {
    std::string source = {}; // liver or block
    std::string out = {};
    resect::Lattice lattice = {};
    std::vector<double> size = {0.1, 0.1, 0.1};
    std::vector<int> cells = {10, 10, 10};
    std::string split = "six";
};

struct PictureOptions {
    std::vector<std::string> surfaces = {};
    std::string out = {};
    std::vector<std::string> rest = {}; // passed on to the picture page's command
};

struct BenchOptions {
    std::vector<std::string> names = {};
    std::string json = {};
    int threads = 0;
    std::string isa = {}; // of step: this one only
    bool large = false;   // of step
    unsigned seeds = 5;
    double minutes = 1;     // of fuzz
    std::uint64_t seed = 1; // of fuzz
    std::string out = "fuzz_cases";
};

struct LabOptions {
    std::string out = "out/lab";
    bool quick = false;
};

int run(const RunOptions& options);
int replay(const ReplayOptions& options);
int serve(const ServeOptions& options);
int mesh(const MeshOptions& options);
int info(const std::string& path);
int picture(const PictureOptions& options);
int bench(const BenchOptions& options);
int lab(const LabOptions& options);
int check_references(const LabOptions& options);

/// Prints the line and returns `refused`.
int refuse(const std::string& line);

} // namespace cli
