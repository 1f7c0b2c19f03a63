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
        network_ = resect::must(server::Network::listen({.port = 0}, std::move(pages), inbox_));
        const std::string scenes = RESECT_SOURCE_FOLDER "/scenes";
        theatre_ = std::make_unique<server::Theatre>(
            server::TheatreOptions{.scenes = server::list_scenes(scenes),
                                   .first = {scene, scene, {}, scenes + "/" + scene + ".json"},
                                   .threads = 1,
                                   .folder = folder.file("out")},
            inbox_,
            [this](server::ClientId client, std::shared_ptr<const std::string> bytes, bool is_binary) {
                network_->send(client, std::move(bytes), is_binary);
            });
        resect::must(theatre_->open());
        simulation_ = std::thread([this] { theatre_->run(); });
        io_ = std::thread([this] { network_->run(); });
    }
    ~LiveServer() {
        inbox_.close();
        simulation_.join();
        network_->stop();
        io_.join();
    }
    LiveServer(const LiveServer&) = delete;
    LiveServer& operator=(const LiveServer&) = delete;

    int port() const { return network_->port(); }

    resect::TemporaryFolder folder = {};

private:
    server::Inbox inbox_ = {};
    std::unique_ptr<server::Network> network_ = {};
    std::unique_ptr<server::Theatre> theatre_ = {};
    std::thread simulation_ = {}, io_ = {};
};
