// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <thread>

#include "server/serve.hpp"
#include "temporary_folder.hpp"

/// `resect serve` in this process, on any port.
class LiveServer {
public:
    explicit LiveServer(const std::string& scene = "cuboid", server::Pages pages = {}) {
        const std::string scenes = RESECT_SOURCE_FOLDER "/scenes";
        server_ = resect::must(
            server::Server::open({.network = {.port = 0},
                                  .theatre = {.scenes = server::list_scenes(scenes),
                                              .first = {scene, scene, {}, scenes + "/" + scene + ".json"},
                                              .threads = 1,
                                              .folder = folder.file("out")}},
                                 std::move(pages)));
        io_ = std::thread([this] { server_->run(); });
    }
    ~LiveServer() {
        server_->stop();
        io_.join();
    }
    LiveServer(const LiveServer&) = delete;
    LiveServer& operator=(const LiveServer&) = delete;

    int port() const { return server_->port(); }

    resect::TemporaryFolder folder = {};

private:
    std::unique_ptr<server::Server> server_ = {};
    std::thread io_ = {};
};
