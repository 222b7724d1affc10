// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/http/connection.hpp"
#include "server/http_message.hpp"
#include "server/limits.hpp"

namespace tinsmith::server {

struct HttpOptions {
    std::string host = "127.0.0.1";
    int port = 8080;  ///< 0: any free one
    std::size_t threads = 32;
    Limits limits;
    std::size_t max_connections = 10'000;     ///< open at the same time
    std::chrono::seconds keep_alive{60};      ///< for which a connection may idle
    std::chrono::seconds head_deadline{10};   ///< for a whole head
    std::chrono::seconds wait{10};            ///< for one read or write of a body or an answer
    std::chrono::seconds body_deadline{120};  ///< for a whole body
    /// For bodies and answers the time above is given in any case, and more to who sends or takes
    /// at least so many bytes a second.
    std::chrono::seconds patience{10};
    std::size_t slowest = 8192;
};

/// The socket side: takes requests off connections, has them judged by `check_request_head`, reads
/// their bodies, hands them to one function and writes what it answers.
///
/// Laws: the handler is called on one of `threads` threads and only with whole bodies; a connection
/// that idles or whose head drips in holds none (reception.hpp); each answer is told with its time;
/// a refusal that leaves bytes unread closes the connection.
/// Not promised: ranges, and service while all threads are held by bodies that drip in and answers
/// that nobody reads, which takes ten seconds each at most unless they are fed; a proxy in front
/// gives it.
class HttpServer {
  public:
    /// Who may ask, by the head: nothing, and perhaps a word on who it is, or what is answered
    /// instead before the body is read, and before a client that asks whether to send it is told
    /// to.
    using Admit = std::function<std::optional<Response>(Request& head)>;
    using Answer = std::function<Response(const Request&)>;
    using Finish = std::function<void(const Request&, Response&)>;
    using Told = std::function<void(const Request&, const Response&, double seconds)>;

    struct Calls {
        Admit admit;
        Answer answer;
        Finish finish;  ///< has the last word on every answer, those that no handler gave included
        Told told;      ///< hears of each, with the time since its head was read; must not throw
    };

    HttpServer(HttpOptions options, Calls calls);
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    /// Binds and listens. Returns the port, or 0 with the reason in `error`: a port that another
    /// process holds is refused, never shared.
    int bind(std::string& error);

    /// Serves until `stop`; what has arrived is answered first. False: the socket failed. Once.
    /// Requires: bind() returned a port.
    bool serve();

    /// From now on each answer ends its connection, so that clients go elsewhere.
    void drain();

    /// Its connections, for as long as somebody looks at them.
    std::shared_ptr<const ConnectionTotals> connections() const;

    /// Closes the listening socket; drains. From any thread but not from a signal handler.
    void stop();

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tinsmith::server
