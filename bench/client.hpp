// SPDX-License-Identifier: Apache-2.0
// A page's end of a WebSocket (RFC 6455), written by hand so that the server is not judged by its own
// library, and so that it can send what no library would.
#pragma once

#include <algorithm>
#include <arpa/inet.h>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace bench {

/// A connection; reads give up after some seconds.
class Client {
public:
    explicit Client(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        const timeval patience = {10, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
        sockaddr_in address = {};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        is_open_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
    }
    ~Client() { ::close(socket_); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    /// Asks for a path, and answers the head of the response and what there is of the body.
    std::string ask(const std::string& path, const std::string& headers) {
        send_raw("GET " + path + " HTTP/1.1\r\n" + headers + "\r\n");
        while (is_open_ && bytes_.find("\r\n\r\n") == std::string::npos) {
            receive();
        }
        const std::size_t end = std::min(bytes_.find("\r\n\r\n"), bytes_.size() - 4) + 4;
        std::string head = bytes_.substr(0, end);
        bytes_.erase(0, end);
        return head;
    }

    /// The head of the answer to the handshake.
    std::string upgrade(const std::string& host = "localhost", const std::string& more = "") {
        return ask("/ws", "Host: " + host + "\r\n" + more +
                              "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n");
    }

    void send_raw(const std::string& bytes) {
        std::size_t sent = 0;
        while (is_open_ && sent < bytes.size()) {
            const ssize_t n = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
            if (n <= 0) { is_open_ = false; }
            sent += static_cast<std::size_t>(std::max<ssize_t>(n, 0));
        }
    }

    void send_message(unsigned kind, const std::string& payload) {
        std::string frame(1, static_cast<char>(0x80U | kind));
        const auto add = [&](std::uint64_t value, int count) {
            for (int i = count - 1; i >= 0; --i) {
                frame += static_cast<char>((value >> (8 * i)) & 0xFFU);
            }
        };
        if (payload.size() < 126) {
            add(0x80U | payload.size(), 1);
        } else if (payload.size() < 65536) {
            add(0x80U | 126U, 1);
            add(payload.size(), 2);
        } else {
            add(0x80U | 127U, 1);
            add(payload.size(), 8);
        }
        frame += std::string(4, '\0'); // a mask of zeros
        send_raw(frame + payload);
    }
    void send_text(const std::string& text) { send_message(1, text); }
    void send_binary(const std::string& bytes) { send_message(2, bytes); }

    struct Received {
        unsigned kind = 0; // 1 text, 2 binary, 8 close
        std::string payload = {};
    };
    /// Nothing where the connection has ended.
    std::optional<Received> read() {
        const std::string head = take(2);
        if (head.size() < 2) { return {}; }
        std::uint64_t size = static_cast<unsigned char>(head[1]) & 0x7FU;
        const int wide = size == 126 ? 2 : size == 127 ? 8 : 0;
        if (wide > 0) {
            size = 0;
            for (const char c : take(static_cast<std::size_t>(wide))) {
                size = size << 8U | static_cast<unsigned char>(c);
            }
        }
        Received received = {static_cast<unsigned char>(head[0]) & 0x0FU, take(size)};
        if (received.kind == 8) { // a good-bye is answered, and ends the connection
            send_message(8, received.payload.substr(0, 2));
            is_open_ = false;
        }
        if (received.kind != 9) { return received; }
        send_message(10, received.payload); // a ping
        return read();
    }

    /// Texts until one has `key`, frames acknowledged; null where none came in 20 s.
    nlohmann::json read_until(const std::string& key) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        for (std::optional<Received> received = read(); received; received = read()) {
            if (std::chrono::steady_clock::now() > end) { return nullptr; }
            if (received->kind == 8) { return nullptr; }
            if (received->kind == 2) {
                last_binary = received->payload;
                std::uint32_t frame = 0;
                std::memcpy(&frame, received->payload.data() + 8, sizeof(frame));
                send_text("{\"seen\":" + std::to_string(frame) + "}");
                continue;
            }
            nlohmann::json text = nlohmann::json::parse(received->payload);
            if (text.contains(key)) { return text[key]; }
        }
        return nullptr;
    }

    /// Reads statuses up to the first with so many pieces; null where none came.
    nlohmann::json wait_for_pieces(int count) {
        for (int i = 0; i < 100 && is_open_; ++i) {
            nlohmann::json status = read_until("status");
            if (status.is_object() && status["piece_count"] == count) { return status; }
        }
        return {};
    }

    bool is_open() const { return is_open_; }

    std::string last_binary = {};

private:
    std::string take(std::size_t count) {
        while (is_open_ && bytes_.size() < count) {
            receive();
        }
        std::string taken = bytes_.substr(0, count);
        bytes_.erase(0, taken.size());
        return taken;
    }

    void receive() {
        char chunk[65536];
        const ssize_t n = ::recv(socket_, chunk, sizeof(chunk), 0);
        if (n <= 0) { is_open_ = false; }
        bytes_.append(chunk, static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    }

    int socket_ = -1;
    bool is_open_ = false;
    std::string bytes_ = {};
};

} // namespace bench
