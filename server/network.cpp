// SPDX-License-Identifier: Apache-2.0
#include "network.hpp"

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <csignal>
#include <deque>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "texts.hpp"

namespace server {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Failure = beast::error_code;

constexpr std::size_t longest_text = std::size_t{64} << 10U;
constexpr std::size_t longest_upload = std::size_t{64} << 20U;
constexpr std::size_t longest_queue = 1000; // messages to one client
constexpr std::size_t most_connections = 64;
constexpr double messages_per_second = 2000;
constexpr std::chrono::seconds patience(10); // for requests, and for answers to pings

/// Allows so many in a second, and as many at once.
class RateLimit {
public:
    bool allow() {
        const Clock::time_point now = Clock::now();
        const double passed = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        left_ = std::min(messages_per_second, left_ + passed * messages_per_second);
        left_ -= 1;
        return left_ >= 0;
    }

private:
    double left_ = messages_per_second;
    Clock::time_point last_ = Clock::now();
};

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

/// Without the port.
std::string_view name_of(std::string_view host) {
    if (host.starts_with('[')) { return host.substr(0, host.find(']') + 1); }
    return host.substr(0, host.find(':'));
}

bool is_address(std::string_view name) {
    if (name.starts_with('[') && name.ends_with(']')) { name = name.substr(1, name.size() - 2); }
    Failure failure;
    asio::ip::make_address(std::string(name), failure);
    return !failure;
}

} // namespace

bool is_welcome(std::string_view host, std::string_view origin, const std::vector<std::string>& names) {
    const std::string_view name = name_of(host);
    const bool is_known =
        name == "localhost" || is_address(name) || std::find(names.begin(), names.end(), name) != names.end();
    if (!is_known) { return false; }
    for (const std::string_view scheme : {"http://", "https://"}) {
        if (origin.starts_with(scheme)) { return origin.substr(scheme.size()) == host; }
    }
    return origin.empty();
}

class WebSocketSession;

struct Listener {
    Listener(const NetworkOptions& told, Pages loaded, Inbox& to)
        : options(told), pages(std::move(loaded)), inbox(to) {}

    void accept();

    NetworkOptions options;
    Pages pages;
    Inbox& inbox;
    std::map<ClientId, std::weak_ptr<WebSocketSession>> clients = {};
    ClientId last_client = 0;
    std::size_t connections = 0;
    ClientId uploader = 0; // the one client that may send much at once now; 0: nobody does
    // Last: sessions end with it, and sign off above.
    asio::io_context io = asio::io_context(1);
    tcp::acceptor acceptor = tcp::acceptor(io);
    asio::signal_set signals = asio::signal_set(io);
};

/// One page: a WebSocket after its handshake. Lives as long as a read or a write of it is under way.
class WebSocketSession : public std::enable_shared_from_this<WebSocketSession> {
public:
    WebSocketSession(Listener& listener, beast::tcp_stream stream)
        : listener_(listener), socket_(std::move(stream)), id_(++listener.last_client) {}
    ~WebSocketSession() {
        --listener_.connections;
        if (listener_.uploader == id_) { listener_.uploader = 0; }
        listener_.clients.erase(id_);
        if (is_open_) { listener_.inbox.put({id_, Left{}}); }
    }
    WebSocketSession(const WebSocketSession&) = delete;
    WebSocketSession& operator=(const WebSocketSession&) = delete;

    void start(http::request<http::string_body> request) {
        websocket::stream_base::timeout times = {};
        times.handshake_timeout = patience;
        times.idle_timeout = patience;
        times.keep_alive_pings = true;
        socket_.set_option(times);
        socket_.read_message_max(longest_upload);
        socket_.auto_fragment(false); // a frame is one piece; only compression would need a copy
        request_ = std::move(request);
        socket_.async_accept(request_, [self = shared_from_this()](Failure failure) {
            if (failure) { return; }
            self->is_open_ = true;
            self->listener_.clients[self->id_] = self;
            self->listener_.inbox.put({self->id_, Joined{}});
            self->read();
        });
    }

    void send(std::shared_ptr<const std::string> bytes, bool is_binary) {
        if (!is_open_ || is_closing_) { return; }
        if (queue_.size() >= longest_queue) {
            close(websocket::close_code::policy_error, "this client does not read what it is sent");
            return;
        }
        queue_.push_back({std::move(bytes), is_binary});
        if (queue_.size() == 1) { write(); }
    }

private:
    struct Outgoing {
        std::shared_ptr<const std::string> bytes = {};
        bool is_binary = false;
    };

    void write() {
        socket_.binary(queue_.front().is_binary);
        socket_.async_write(asio::buffer(*queue_.front().bytes),
                            [self = shared_from_this()](Failure failure, std::size_t) {
                                if (failure) { return; }
                                self->queue_.pop_front();
                                if (!self->queue_.empty() && !self->is_closing_) { self->write(); }
                            });
    }

    void read() {
        socket_.async_read_some(buffer_, 0, [self = shared_from_this()](Failure failure, std::size_t) {
            if (!failure) { self->hear(); }
        });
    }

    void hear() {
        if (!has_room()) { return; }
        if (socket_.is_message_done()) {
            if (!rate_.allow()) {
                close(websocket::close_code::policy_error,
                      "too many messages; send fewer than 2,000 a second");
                return;
            }
            hear_message();
            buffer_.clear();
            if (listener_.uploader == id_) { listener_.uploader = 0; }
        }
        read();
    }

    /// Closes a connection that sends too much.
    bool has_room() {
        if (buffer_.size() <= longest_text) { return true; }
        if (socket_.got_text()) {
            close(websocket::close_code::too_big, "a text may have 64 KiB");
            return false;
        }
        if (listener_.uploader == 0) { listener_.uploader = id_; }
        if (listener_.uploader != id_) {
            close(websocket::close_code::try_again_later, "another page uploads; try again");
            return false;
        }
        return true;
    }

    void hear_message() {
        const std::string bytes = beast::buffers_to_string(buffer_.data());
        Parsed parsed = socket_.got_text() ? parse_text(bytes) : parse_binary(bytes);
        if (auto* message = std::get_if<Message>(&parsed)) {
            listener_.inbox.put({id_, std::move(*message)});
            return;
        }
        const Refusal& refusal = std::get<Refusal>(parsed);
        send(std::make_shared<const std::string>(refused_text(refusal.id, refusal.message)), false);
    }

    void close(websocket::close_code code, const char* reason) {
        if (std::exchange(is_closing_, true)) { return; }
        socket_.async_close({code, reason}, [self = shared_from_this()](Failure) {});
    }

    Listener& listener_;
    websocket::stream<beast::tcp_stream> socket_;
    ClientId id_ = 0;
    http::request<http::string_body> request_ = {};
    beast::flat_buffer buffer_ = {};
    std::deque<Outgoing> queue_ = {};
    RateLimit rate_ = {};
    bool is_open_ = false, is_closing_ = false;
};

namespace {

using Answer = http::response<http::string_body>;

Answer make_answer(const http::request<http::string_body>& request, http::status status,
                   const std::string& body, const char* type = "text/plain; charset=utf-8") {
    Answer answer(status, request.version());
    answer.set(http::field::content_type, type);
    answer.set(http::field::cache_control, "no-cache");
    answer.set("X-Content-Type-Options", "nosniff");
    answer.set("Content-Security-Policy", "default-src 'self'; img-src 'self' blob: data:; media-src 'self' "
                                          "blob:; connect-src 'self' ws: wss:; "
                                          "style-src 'self' 'unsafe-inline'; frame-ancestors 'none'");
    answer.keep_alive(request.keep_alive());
    answer.body() = body;
    answer.prepare_payload();
    return answer;
}

/// One connection of HTTP, until it becomes a WebSocket or ends.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
public:
    HttpSession(Listener& listener, tcp::socket socket) : listener_(listener), stream_(std::move(socket)) {
        ++listener_.connections;
    }
    ~HttpSession() {
        if (!is_handed_on_) { --listener_.connections; }
    }
    HttpSession(const HttpSession&) = delete;
    HttpSession& operator=(const HttpSession&) = delete;

    void read() {
        parser_.emplace();
        parser_->body_limit(longest_text);
        stream_.expires_after(patience);
        http::async_read(stream_, buffer_, *parser_,
                         [self = shared_from_this()](Failure failure, std::size_t) {
                             if (!failure) { self->serve(); }
                         });
    }

private:
    void serve() {
        http::request<http::string_body> request = parser_->release();
        const std::string_view host = view_of(request[http::field::host]);
        if (!is_welcome(host, view_of(request[http::field::origin]), listener_.options.names)) {
            answer(
                make_answer(request, http::status::forbidden,
                            "Open this page as localhost or by its address; --name allows another name.\n"));
        } else if (listener_.connections > most_connections) {
            answer(make_answer(request, http::status::service_unavailable,
                               "Too many pages are connected; close one.\n"));
        } else if (websocket::is_upgrade(request) && request.target() == "/ws") {
            is_handed_on_ = true;
            stream_.expires_never();
            std::make_shared<WebSocketSession>(listener_, std::move(stream_))->start(std::move(request));
        } else {
            answer(find_page(request));
        }
    }

    Answer find_page(const http::request<http::string_body>& request) const {
        if (request.method() != http::verb::get) {
            return make_answer(request, http::status::method_not_allowed, "This port serves GET only.\n");
        }
        std::string_view path = view_of(request.target());
        path = path.substr(0, path.find('?'));
        const auto found = listener_.pages.find(path);
        if (found == listener_.pages.end()) {
            return make_answer(request, http::status::not_found, "There is no such page.\n");
        }
        return make_answer(request, http::status::ok, found->second.bytes, found->second.type);
    }

    void answer(Answer answer) {
        answer_ = std::move(answer);
        stream_.expires_after(patience);
        http::async_write(stream_, answer_, [self = shared_from_this()](Failure failure, std::size_t) {
            if (failure) { return; }
            if (self->answer_.need_eof()) {
                self->stream_.socket().shutdown(tcp::socket::shutdown_send, failure);
                return;
            }
            self->read();
        });
    }

    Listener& listener_;
    beast::tcp_stream stream_;
    beast::flat_buffer buffer_ = {};
    std::optional<http::request_parser<http::string_body>> parser_ = {};
    Answer answer_ = {};
    bool is_handed_on_ = false;
};

} // namespace

void Listener::accept() {
    acceptor.async_accept([this](Failure failure, tcp::socket socket) {
        if (failure == asio::error::operation_aborted) { return; }
        if (!failure) {
            socket.set_option(tcp::no_delay(true), failure);
            // Beyond the most there is a little room for a refusal in words; then connections are dropped.
            if (connections < 2 * most_connections) {
                std::make_shared<HttpSession>(*this, std::move(socket))->read();
            }
        }
        accept();
    });
}

resect::Result<std::unique_ptr<Network>> Network::listen(const NetworkOptions& options, Pages pages,
                                                         Inbox& inbox) {
    auto listener = std::make_unique<Listener>(options, std::move(pages), inbox);
    Failure failure;
    const asio::ip::address address = asio::ip::make_address(options.address, failure);
    if (failure) {
        return resect::Error{fmt::format("'{}' is no address; give one as 127.0.0.1", options.address)};
    }
    const tcp::endpoint endpoint(address, static_cast<unsigned short>(options.port));
    listener->acceptor.open(endpoint.protocol(), failure);
    if (!failure) { listener->acceptor.set_option(asio::socket_base::reuse_address(true), failure); }
    if (!failure) { listener->acceptor.bind(endpoint, failure); }
    if (!failure) { listener->acceptor.listen(asio::socket_base::max_listen_connections, failure); }
    if (failure) {
        return resect::Error{fmt::format("{}:{} cannot be listened on ({}); give another --port",
                                         options.address, options.port, failure.message())};
    }
    return std::unique_ptr<Network>(new Network(std::move(listener)));
}

Network::Network(std::unique_ptr<Listener> listener) : listener_(std::move(listener)) {}
Network::~Network() = default;

int Network::port() const { return listener_->acceptor.local_endpoint().port(); }

void Network::send(ClientId client, std::shared_ptr<const std::string> bytes, bool is_binary) {
    asio::post(listener_->io, [listener = listener_.get(), client, bytes = std::move(bytes), is_binary] {
        const auto found = listener->clients.find(client);
        if (found == listener->clients.end()) { return; }
        if (const auto session = found->second.lock()) { session->send(bytes, is_binary); }
    });
}

void Network::run() {
    listener_->signals.add(SIGINT);
    listener_->signals.add(SIGTERM);
    listener_->signals.async_wait([this](Failure failure, int) {
        if (!failure) { stop(); }
    });
    listener_->accept();
    listener_->io.run();
}

void Network::stop() { listener_->io.stop(); }

} // namespace server
