// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "inbox.hpp"

namespace server {

/// A file of the page, kept in memory.
struct Page {
    std::string bytes = {};
    const char* type = nullptr;
};
/// By the path that asks for it, as "/simulator.js".
using Pages = std::map<std::string, Page, std::less<>>;

/// All files below `folder`; "/" is index.html.
Pages load_pages(const std::string& folder);

struct NetworkOptions {
    std::string address = "127.0.0.1";
    int port = 8080;                     // 0: any that is free
    std::vector<std::string> names = {}; // hosts that pages may come from, beside localhost and addresses
};

/// Whether a request with this Host, and Origin unless empty, comes from a page of ours. A name that is
/// neither localhost nor told could be made to point here by anyone; an address could not.
bool is_welcome(std::string_view host, std::string_view origin, const std::vector<std::string>& names);

struct Listener; // all that is Boost's

/// Serves pages and WebSockets on one port, on the thread that calls run().
class Network {
public:
    /// Listens at once; an Error if the address is taken or none.
    static resect::Result<std::unique_ptr<Network>> listen(const NetworkOptions& options, Pages pages,
                                                           Inbox& inbox);
    ~Network();

    int port() const;
    /// For any thread.
    void send(ClientId client, std::shared_ptr<const std::string> bytes, bool is_binary);
    /// Until stop(), or a signal that asks the program to end.
    void run();
    void stop(); // for any thread

private:
    explicit Network(std::unique_ptr<Listener> listener);
    std::unique_ptr<Listener> listener_;
};

} // namespace server
