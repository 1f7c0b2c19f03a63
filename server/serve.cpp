// SPDX-License-Identifier: Apache-2.0
#include "serve.hpp"

namespace server {

using namespace resect;

Result<std::unique_ptr<Server>> Server::open(const ServeOptions& options, Pages pages) {
    std::unique_ptr<Server> server(new Server);
    Result<std::unique_ptr<Network>> network =
        Network::listen(options.network, std::move(pages), server->inbox_);
    if (!network) { return network.error(); }
    server->network_ = std::move(*network);
    server->theatre_ = std::make_unique<Theatre>(
        options.theatre, server->inbox_,
        [&to = *server->network_](ClientId client, std::shared_ptr<const std::string> bytes, bool is_binary) {
            to.send(client, std::move(bytes), is_binary);
        });
    if (const Result<void> opened = server->theatre_->open(); !opened) { return opened.error(); }
    server->simulation_ = std::thread([&theatre = *server->theatre_] { theatre.run(); });
    return server;
}

Server::~Server() {
    inbox_.close();
    if (simulation_.joinable()) { simulation_.join(); }
}

Result<void> serve(const ServeOptions& options, const std::string& folder_of_pages,
                   const std::function<void(int port)>& ready) {
    const Result<std::unique_ptr<Server>> server = Server::open(options, load_pages(folder_of_pages));
    if (!server) { return server.error(); }
    ready((*server)->port());
    (*server)->run();
    return {};
}

} // namespace server
