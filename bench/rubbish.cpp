// SPDX-License-Identifier: Apache-2.0
#include "bench/rubbish.hpp"

#include <chrono>

#include "bench/client.hpp"

namespace bench {
namespace {

/// Between a client's connections: fifty clients make about a thousand in a second.
constexpr std::chrono::milliseconds pause{50};

} // namespace

void send_rubbish(int port, int kind) {
    Client client(port);
    switch (kind % 5) {
    case 0:
        client.send_raw(std::string(3000, static_cast<char>(kind)));
        break;
    case 1:
        client.upgrade();
        client.send_raw("\xff\xff\xff\xff rubbish in place of frames");
        break;
    case 2:
        client.upgrade();
        client.send_text("{\"id\":1,");
        client.send_text("{\"id\":1,\"command\":{\"undo\":{}}}");
        break;
    case 3:
        client.send_raw("GET /ws HTTP/1.1\r\nHost: local");
        break;
    default:
        client.upgrade();
        client.send_binary(std::string(20000, static_cast<char>(kind)));
    }
}

RubbishClients::RubbishClients(int port, int count) {
    for (int i = 0; i < count; ++i) {
        threads_.emplace_back([this, port, i] {
            for (int kind = i; !is_over_; ++kind) {
                send_rubbish(port, kind);
                ++connections_;
                std::this_thread::sleep_for(pause);
            }
        });
    }
}

RubbishClients::~RubbishClients() {
    is_over_ = true;
    for (std::thread& thread : threads_) {
        thread.join();
    }
}

} // namespace bench
