// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/http_message.hpp"
#include "server/limits.hpp"

namespace tinsmith::server {

struct HttpOptions {
    std::string host = "127.0.0.1";
    int port = 8080;  ///< 0: any free one
    std::size_t threads = 32;
    Limits limits;
    std::chrono::seconds keep_alive{2};       ///< an idle connection holds a thread that long
    std::chrono::seconds read_timeout{5};     ///< for one read
    std::chrono::seconds body_deadline{120};  ///< for a whole body
};

/// The socket side: takes requests off connections, has them judged by `check_request_head`, reads
/// their bodies, hands them to one function and writes what it answers.
///
/// The library underneath is seen in http_server.cpp alone.
/// Laws: the handler is called on one of `threads` threads and only with whole bodies; each answer
/// is told with its time; a refusal that leaves bytes unread closes the connection.
/// Not promised: pipelining (a second request in the same packet may be dropped), ranges, and
/// service while all threads are held by slow clients; a proxy in front gives these.
class HttpServer {
  public:
    /// Who may ask, by the head: nothing, and perhaps a word on who it is, or what is answered
    /// instead before the body is read. Where `comes_again` the client only wants to know whether
    /// to send its body.
    using Admit = std::function<std::optional<Response>(Request& head, bool comes_again)>;
    using Answer = std::function<Response(const Request&)>;
    using Finish = std::function<void(const Request&, Response&)>;
    using Told = std::function<void(const Request&, const Response&, double seconds)>;

    /// `finish` has the last word on every answer, those that no handler gave included; `told`
    /// hears of each, with the time since its head was read, and must not throw.
    HttpServer(HttpOptions options, Admit admit, Answer answer, Finish finish, Told told);
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    /// Binds and listens. Returns the port, or 0 with the reason in `error`: a port that another
    /// process holds is refused, never shared.
    int bind(std::string& error);

    /// Serves until `stop`; requests under way are answered first. False: the socket failed.
    /// Requires: bind() returned a port.
    bool serve();

    /// From now on each answer ends its connection, so that clients go elsewhere.
    void drain();

    /// Closes the listening socket; drains. From any thread but not from a signal handler.
    void stop();

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tinsmith::server
