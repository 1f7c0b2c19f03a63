// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "options.hpp"

namespace cli {

namespace {

/// Runs a program found on the path and waits for it; 127: it could not be started.
int run_and_wait(std::vector<std::string> words) {
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        execvp(arguments[0], arguments.data());
        _exit(127);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) < 0 || !WIFEXITED(status)) { return 127; }
    return WEXITSTATUS(status);
}

} // namespace

/// The page that draws, and the command that opens it in Chromium, live in web/.
int picture(const PictureOptions& options) {
    const std::filesystem::path command = std::filesystem::path(RESECT_WEB_FOLDER) / "picture.mjs";
    if (!std::filesystem::exists(command)) {
        return refuse(fmt::format("picture: {} is missing; keep the source folder that resect was built from",
                                  command.string()));
    }
    std::vector<std::string> words{"node", command.string()};
    words.insert(words.end(), options.surfaces.begin(), options.surfaces.end());
    words.insert(words.end(), {"--out", options.out});
    words.insert(words.end(), options.rest.begin(), options.rest.end());
    const int status = run_and_wait(std::move(words));
    if (status == 127) { return refuse("picture: node could not be started; ./run picture installs it"); }
    return status == 0 ? done : refused;
}

} // namespace cli
