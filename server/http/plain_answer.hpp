// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "server/http_message.hpp"

namespace tinsmith::server {

/// What can be told of bytes that are no request, for the answer and the log: the method and the
/// path where they are plain, else "-" and nothing.
Request request_of_bytes(std::string_view bytes);

/// The last answer of a connection as HTTP/1.1, for what the HTTP library has not read.
std::string write_last_answer(const Response& response, std::string_view title, bool with_body);

}  // namespace tinsmith::server
