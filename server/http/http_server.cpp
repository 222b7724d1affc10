// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_server.hpp"

#include <optional>
#include <utility>

#include "server/http/crew.hpp"
#include "server/http/descriptors.hpp"
#include "server/http/listener.hpp"
#include "server/http/protocol.hpp"
#include "server/http/reception.hpp"
#include "server/http/request_head.hpp"

namespace tinsmith::server {

namespace {

/// A thread that has answered waits so long for the next request of its client, where nobody else
/// needs it: the way over the reception costs one that asks again at once two changes of threads.
constexpr std::chrono::milliseconds kLookAgain{50};

const api::Problem kTooManyWait{
    api::ProblemType::Busy,
    "More requests wait than the server holds; nothing was done. Send it again when Retry-After "
    "says.",
    {}};

ReceptionOptions reception_of(const HttpOptions& options) {
    ReceptionOptions reception;
    reception.max_connections = allow_connections(options.max_connections);
    reception.head = options.head_deadline;
    reception.idle = options.keep_alive;
    return reception;
}

}  // namespace

class HttpServer::Impl {
  public:
    Impl(HttpOptions options, Calls calls)
        : options_(std::move(options)), protocol_(options_, std::move(calls)) {}

    int bind(std::string& error) {
        const Listener listener = listen_on(options_.host, options_.port);
        error = listener.error;
        if (listener.socket < 0) return 0;
        reception_.emplace(listener.socket, reception_of(options_), *totals_,
                           [this](Arrival arrival) { receive(std::move(arrival)); });
        return listener.port;
    }

    bool serve() {
        crew_.emplace(options_.threads, [this](Arrival arrival) { attend(std::move(arrival)); });
        const bool fine = reception_->run();
        crew_->finish();
        return fine;
    }

    std::shared_ptr<const ConnectionTotals> connections() const { return totals_; }

    void drain() { protocol_.drain(); }

    void stop() {
        drain();
        if (reception_) reception_->stop();
    }

  private:
    using After = Protocol::After;

    /// Has it answered by a thread, or refuses it at once: without waiting, since it may be the
    /// reception's thread.
    void receive(Arrival arrival) {
        if (crew_->add(arrival)) return;
        const After after = protocol_.refuse_bytes(*arrival.connection, kTooManyWait, false);
        if (after == After::Part) reception_->part(std::move(arrival.connection));
    }

    /// Answers what has arrived, and what comes next on its connection, as long as nobody else
    /// waits for the thread.
    void attend(Arrival arrival) {
        Connection& connection = *arrival.connection;
        After after = answer(connection, std::exchange(arrival.state, Arrival::State::Whole));
        while (after == After::Keep) {
            if (!is_next_here(connection)) {
                arrival.connection = reception_->keep(std::move(arrival.connection));
                if (!arrival.connection) return;
                // The server stops: what has come by now is the last.
                if (connection.receive(kMaxHeadBytes) != Connection::Got::Bytes ||
                    !is_whole(connection))
                    return;
            } else if (crew_->is_behind() && crew_->add(arrival)) {
                return;
            }
            after = answer(connection, Arrival::State::Whole);
        }
        if (after == After::Part) reception_->part(std::move(arrival.connection));
    }

    After answer(Connection& connection, Arrival::State state) const {
        if (state == Arrival::State::TooLarge)
            return protocol_.refuse_bytes(connection, head_too_large(connection.unread()));
        if (state == Arrival::State::Late) {
            return protocol_.refuse_bytes(
                connection,
                {api::ProblemType::RequestTimeout,
                 "The request's head took too long to arrive; nothing was done. Send it again.",
                 {}});
        }
        std::size_t size = connection.size_of_head();
        if (const auto problem = check_head_bytes(connection.unread().substr(0, size)))
            return protocol_.refuse_bytes(connection, *problem);
        while (const auto range = range_of_other_unit(connection.unread().substr(0, size))) {
            connection.cut(range->begin, range->size);
            size -= range->size;
        }
        return protocol_.exchange(connection);
    }

    /// Whether the head of another request is there, or comes at once.
    bool is_next_here(Connection& connection) const {
        if (!connection.unread().empty()) return is_whole(connection);
        if (!crew_->has_spare() || !connection.wait_readable(kLookAgain)) return false;
        return connection.receive(kMaxHeadBytes) == Connection::Got::Bytes && is_whole(connection);
    }

    static bool is_whole(Connection& connection) {
        const std::size_t size = connection.size_of_head();
        return size > 0 && size <= kMaxHeadBytes;
    }

    const HttpOptions options_;
    Protocol protocol_;
    const std::shared_ptr<ConnectionTotals> totals_ = std::make_shared<ConnectionTotals>();
    std::optional<Reception> reception_;
    std::optional<Crew> crew_;
};

HttpServer::HttpServer(HttpOptions options, Calls calls)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(calls))) {}

HttpServer::~HttpServer() = default;

int HttpServer::bind(std::string& error) {
    return impl_->bind(error);
}

bool HttpServer::serve() {
    return impl_->serve();
}

std::shared_ptr<const ConnectionTotals> HttpServer::connections() const {
    return impl_->connections();
}

void HttpServer::drain() {
    impl_->drain();
}

void HttpServer::stop() {
    impl_->stop();
}

}  // namespace tinsmith::server
