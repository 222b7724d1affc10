// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "server/http_message.hpp"

namespace tinsmith::server {

/// The log goes to standard error, one line an event. Clients' bytes are escaped before they get
/// there, so that no request can forge a line.
enum class LogLevel { Debug, Info, Warning, Error, Off };

void set_log_level(LogLevel level);
void log_info(std::string_view text);
void log_warning(std::string_view text);
void log_error(std::string_view text);

/// One line: method, path, status, bytes sent, milliseconds, request id, client, and the
/// trace where the request belongs to one.
void log_request(const Request& request, const Response& response, double milliseconds);

/// Printable ASCII as it is, the rest as \xNN; cut after 200 bytes.
std::string sanitized(std::string_view text);

}  // namespace tinsmith::server
