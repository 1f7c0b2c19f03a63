// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace bench {

/// Connects to a server on this machine, sends it what no page would, one of several kinds, and leaves.
void send_rubbish(int port, int kind);

/// Clients that connect, send rubbish and leave, again and again, until this is destroyed.
class RubbishClients {
public:
    RubbishClients(int port, int count);
    ~RubbishClients();
    RubbishClients(const RubbishClients&) = delete;
    RubbishClients& operator=(const RubbishClients&) = delete;

    std::int64_t connections() const { return connections_; }

private:
    std::atomic<bool> is_over_ = false;
    std::atomic<std::int64_t> connections_ = 0;
    std::vector<std::thread> threads_ = {};
};

} // namespace bench
