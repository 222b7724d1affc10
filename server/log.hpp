// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string_view>

#include "server/http_message.hpp"
#include "server/log_line.hpp"

namespace tinsmith::server {

/// The log goes to standard error, one line an event: a JSON object for programs, or a text for
/// people. Clients' bytes are escaped before they get there, so that no request can forge a line.
///
/// Each object has "time" (RFC 3339, with milliseconds), "level" ("debug", "info", "warning",
/// "error") and "event", a word that stays the same from release to release: alerts may rest on it.
/// docker/README.md lists them.
enum class LogLevel { Debug, Info, Warning, Error, Off };

/// Auto: text where standard error is a terminal, because a person reads it; else JSON, because
/// what collects logs from a pipe or a file wants members, and nobody has to ask for them.
enum class LogFormat { Auto, Json, Text };

void set_log_level(LogLevel level);
/// Before the first line.
void set_log_format(LogFormat format);

/// `message` says it to people.
void log_event(LogLevel level, std::string_view event, std::string_view message,
               std::initializer_list<LogField> fields = {});

/// One line: method, path, route, status, bytes both ways, milliseconds, request id, client, the
/// name of the API key (never the key), the word of the problem where it was refused, and the trace
/// where it belongs to one. What failed in the server is an error, what it had no room or time for
/// a warning; what monitors ask for all day is told at level debug.
void log_request(const Request& request, const Response& response, double milliseconds);

/// Bytes of the body as it goes out: none to HEAD.
std::size_t bytes_sent(const Request& request, const Response& response);

}  // namespace tinsmith::server
