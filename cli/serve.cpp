// SPDX-License-Identifier: Apache-2.0
#include "server/serve.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <thread>

#include "options.hpp"

namespace cli {

namespace {

namespace fs = std::filesystem;

/// Half of the cores: the page and the network want theirs.
int default_threads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / 2); }

void open_browser(const std::string& address) {
    if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) { return; }
    // Where there is no xdg-open, the address has been printed.
    [[maybe_unused]] const int status =
        std::system(fmt::format("xdg-open {} >/dev/null 2>&1 &", address).c_str());
}

server::TheatreOptions theatre_options(const ServeOptions& options) {
    const fs::path scene = fs::absolute(options.scene);
    server::TheatreOptions theatre = {
        .scenes = server::list_scenes(scene.parent_path().string()),
        .threads = options.threads > 0 ? options.threads : default_threads(),
        .folder = options.out,
    };
    const auto found =
        std::find_if(theatre.scenes.begin(), theatre.scenes.end(),
                     [&](const server::SceneEntry& one) { return one.name == scene.stem().string(); });
    theatre.first =
        found != theatre.scenes.end()
            ? *found
            : server::SceneEntry{scene.stem().string(), scene.stem().string(), {}, scene.string()};
    return theatre;
}

} // namespace

int serve(const ServeOptions& options) {
    const fs::path pages = fs::path(RESECT_WEB_FOLDER) / "dist/simulator";
    if (!fs::exists(pages / "index.html")) {
        return refuse(
            fmt::format("serve: {} is missing; ./run builds the page", (pages / "index.html").string()));
    }
    const server::ServeOptions told = {
        .network = {.address = options.address, .port = options.port, .names = options.names},
        .theatre = theatre_options(options),
    };
    const resect::Result<void> served = server::serve(told, pages.string(), [&](int port) {
        const std::string address = fmt::format(
            "http://{}:{}/", options.address == "127.0.0.1" ? "localhost" : options.address, port);
        fmt::print("Open {} and cut; Ctrl-C ends it.\n", address);
        std::fflush(stdout);
        if (options.open) { open_browser(address); }
    });
    return served ? done : refuse(served.error().message);
}

} // namespace cli
