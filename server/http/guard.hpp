// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "api/problem.hpp"
#include "server/http_message.hpp"
#include "server/limits.hpp"

namespace tinsmith::server {

/// Judges a request by its head, before one byte of the body is read: everything that could make
/// the two ends disagree on where the request ends, or make a small request cost a lot.
/// A refused connection must be closed, because its body was not read. Nothing: go on.
/// Requires: `request.path` as sent and all headers, repeated ones included.
std::optional<api::Problem> check_request_head(const Request& request, const Limits& limits);

/// True for the methods whose body the server reads.
bool takes_body(const std::string& method);

/// True where its head says that a body follows.
bool brings_body(const Request& request);

/// True where the client wants no further request on its connection (RFC 9112 9.6).
bool asks_to_close(const Request& request);

/// True where an HTTP/1.1 client wants a word before it sends its body (RFC 9110 10.1.1).
bool awaits_invitation(const Request& request);

}  // namespace tinsmith::server
