// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/http_message.hpp"

namespace tinsmith::server {

/// A request before its body is read.
struct Head {
    Request request;    ///< it can be answered even where it is broken
    std::string fault;  ///< what is broken in it; empty: nothing
};

/// The request of a head as the HTTP library has split it; names of headers in small letters. It
/// has the sender's request id where that is sane, else one of its own, and its trace.
Head read_head(std::string method, std::string_view version, const std::string& target,
               std::vector<NameValue> headers);

}  // namespace tinsmith::server
