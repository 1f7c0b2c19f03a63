// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <thread>

#include "network.hpp"
#include "theatre.hpp"

namespace server {

struct ServeOptions {
    NetworkOptions network = {};
    TheatreOptions theatre = {};
};

/// Pages on a port, and the simulation that they play with, on a thread of its own.
class Server {
public:
    /// Listens and starts the first scene.
    static resect::Result<std::unique_ptr<Server>> open(const ServeOptions& options, Pages pages);
    ~Server();

    int port() const { return network_->port(); }
    /// Serves until stop(), or a signal that asks the program to end.
    void run() { network_->run(); }
    void stop() { network_->stop(); } // for any thread

private:
    Server() = default;

    Inbox inbox_ = {};
    std::unique_ptr<Network> network_ = {};
    std::unique_ptr<Theatre> theatre_ = {};
    std::thread simulation_ = {};
};

/// Serves until a signal ends it; `ready` is called with the port once pages can be opened.
resect::Result<void> serve(const ServeOptions& options, const std::string& folder_of_pages,
                           const std::function<void(int port)>& ready);

} // namespace server
