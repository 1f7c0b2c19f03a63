// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <fmt/format.h>
#include <string>
#include <unistd.h>

namespace cli {

/// One live line on stderr, on a terminal only.
class Progress {
public:
    void show(const std::string& line) {
        if (!terminal_) { return; }
        fmt::print(stderr, "\r\x1b[K{}", line);
        std::fflush(stderr);
        shown_ = true;
    }
    void clear() {
        if (shown_) { fmt::print(stderr, "\r\x1b[K"); }
        shown_ = false;
    }
    ~Progress() { clear(); }
    Progress() = default;
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

private:
    bool terminal_ = isatty(STDERR_FILENO) != 0;
    bool shown_ = false;
};

} // namespace cli
