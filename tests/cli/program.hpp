// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/wait.h>

#include "temporary_folder.hpp"

namespace resect {

inline std::string read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

inline void write_text(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

struct Outcome {
    int status = -1;
    std::string out = {}, err = {};
};

/// Runs resect with these words (as a shell reads them).
inline Outcome run_resect(const std::string& words) {
    const TemporaryFolder folder;
    const std::string command =
        fmt::format("{} {} > {} 2> {}", RESECT_PROGRAM, words, folder.file("out"), folder.file("err"));
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder.file("out")),
            read_text(folder.file("err"))};
}

/// A refusal: status 2, nothing on standard output, one line on standard error.
inline bool is_refusal(const Outcome& outcome) {
    return outcome.status == 2 && outcome.out.empty() && outcome.err.size() > 12 &&
           outcome.err.find('\n') == outcome.err.size() - 1;
}

inline std::string scene(const std::string& name) {
    return fmt::format("{}/scenes/{}", RESECT_SOURCE_FOLDER, name);
}

} // namespace resect
