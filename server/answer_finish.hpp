// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/http_message.hpp"
#include "server/policy.hpp"

namespace tinsmith::server {

/// Whether this answer goes out as gzip: JSON, or a file of a page, of more than a packet, to a
/// client that takes it.
/// Never what is compressed already (a Draco GLB gains nothing).
bool wants_gzip(const Request& request, const Response& response);

/// The body as gzip, Content-Encoding told, and the strong tag of a read changed by kGzipSuffix,
/// because RFC 9110 8.8.1 wants strong tags to differ where the bytes do. False: the library failed
/// and the answer is as it was.
bool encode_as_gzip(const Request& request, Response& response);

/// Adds a name to the one Vary header, unless it is there.
void add_vary(Response& response, std::string_view name);

/// What every answer gets at the end, refusals of the guard included, in this order: gzip, Vary,
/// the trace it belongs to, and what a browser must be told to let a page of another origin read
/// it. Origins that are not allowed are told nothing. Changes no status.
void finish_answer(const Policy& policy, const Request& request, Response& response);

}  // namespace tinsmith::server
