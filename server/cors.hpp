// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "server/http_message.hpp"
#include "server/policy.hpp"

namespace tinsmith::server {

/// Lets pages of the operator's origins call and read (the CORS protocol of the Fetch standard).
///
/// Laws: an origin is allowed when it is on the list to the letter, or when the list has "*"; any
/// other is told nothing at all. Credentials (cookies) are never allowed. An answer to OPTIONS that
/// has Allow becomes the answer to a preflight where it is one: the path's methods, and of the
/// headers asked for those that the service reads. `Vary: Origin` wherever the answer depends on
/// it.
void allow_origin(const Policy& policy, const Request& request, Response& response);

/// The request headers that mean something here, lower-case.
std::span<const std::string_view> understood_headers();

/// The headers of answers that pages may read, as a list.
std::string_view exposed_headers();

}  // namespace tinsmith::server
