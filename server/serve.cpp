// SPDX-License-Identifier: Apache-2.0
#include "serve.hpp"

#include <thread>

namespace server {

resect::Result<void> serve(const ServeOptions& options, const std::function<void(int port)>& ready) {
    Inbox inbox;
    resect::Result<std::unique_ptr<Network>> network =
        Network::listen(options.network, load_pages(options.pages), inbox);
    if (!network) { return network.error(); }
    Theatre theatre(options.theatre, inbox,
                    [&](ClientId client, std::shared_ptr<const std::string> bytes, bool is_binary) {
                        (*network)->send(client, std::move(bytes), is_binary);
                    });
    if (resect::Result<void> opened = theatre.open(); !opened) { return opened; }
    std::thread simulation([&] { theatre.run(); });
    ready((*network)->port());
    (*network)->run();
    inbox.close();
    simulation.join();
    return {};
}

} // namespace server
