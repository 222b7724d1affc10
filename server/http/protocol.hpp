// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "api/problem.hpp"
#include "server/http/connection.hpp"
#include "server/http/http_server.hpp"

namespace tinsmith::server {

/// HTTP/1.1 on a connection: one request after the other, each judged by `check_request_head`
/// before its body is read. The library underneath is seen in library.hpp and protocol.cpp
/// alone.
class Protocol {
  public:
    /// What is to become of the connection.
    enum class After {
        Keep,  ///< it waits for its next request
        Part,  ///< the answer was the last
        Drop,  ///< it is broken
    };

    Protocol(const HttpOptions& options, HttpServer::Calls calls);
    ~Protocol();
    Protocol(const Protocol&) = delete;
    Protocol& operator=(const Protocol&) = delete;

    /// Answers the request whose head is at the beginning of what the connection holds. From any
    /// thread. Requires: the head is whole.
    After exchange(Connection& connection) const;

    /// Answers what is no request, or none yet. `may_wait`: for the client to take the answer.
    After refuse_bytes(Connection& connection, const api::Problem& problem,
                       bool may_wait = true) const;

    /// From now on each answer ends its connection.
    void drain();

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tinsmith::server
