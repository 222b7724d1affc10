// SPDX-License-Identifier: Apache-2.0
#include "server/http/guard.hpp"

#include <algorithm>
#include <charconv>
#include <string>

#include "api/field_list.hpp"
#include "server/entity_tag.hpp"

namespace tinsmith::server {

namespace {

using api::Problem;
using api::ProblemType;

std::size_t count_headers(const Request& request, std::string_view name) {
    return static_cast<std::size_t>(
        std::count_if(request.headers.begin(), request.headers.end(),
                      [name](const NameValue& header) { return header.first == name; }));
}

/// Digits only: "+5", "0x5", "5, 5" and " 5" are read differently by different programs.
std::optional<std::uint64_t> parse_length(std::string_view text) {
    std::uint64_t length = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, length);
    if (text.empty() || error != std::errc() || stop != end) return std::nullopt;
    return length;
}

/// In lower case.
std::string expectations(const Request& request) {
    return api::lower_case(combined_field(request, "expect").value_or(""));
}

constexpr std::string_view kInvitation = "100-continue";

std::optional<Problem> check_expectations(const Request& request) {
    const std::string all = expectations(request);
    for (std::string_view rest = all; !rest.empty();) {
        const std::string_view one = api::take_part(rest, ',');
        if (one.empty() || one == kInvitation) continue;
        return Problem{ProblemType::ExpectationFailed,
                       "The only expectation that is known here is 100-continue.",
                       {}};
    }
    return std::nullopt;
}

std::optional<Problem> check_length(const Request& request, const Limits& limits) {
    const std::size_t count = count_headers(request, "content-length");
    if (count > 1) return Problem{ProblemType::BadRequest, "Send one Content-Length header.", {}};
    if (count == 0) return std::nullopt;  // an empty body (RFC 9112 6.3)
    const auto length = parse_length(*request.header("content-length"));
    if (!length) {
        return Problem{ProblemType::BadRequest, "Content-Length is not a decimal number.", {}};
    }
    if (*length > 0 && !takes_body(request.method)) {
        return Problem{ProblemType::BadRequest,
                       "A " + request.method + " request takes no body here: leave it out.",
                       {}};
    }
    if (*length > limits.max_body_bytes) {
        return Problem{ProblemType::BodyTooLarge,
                       "The body has " + std::to_string(*length) +
                           " bytes, the limit max_body_bytes is " +
                           std::to_string(limits.max_body_bytes) +
                           ". Send less, or start the server with a larger --max-body-bytes.",
                       {}};
    }
    return std::nullopt;
}

}  // namespace

bool takes_body(const std::string& method) {
    return method == "POST" || method == "PUT" || method == "PATCH" || method == "DELETE";
}

bool asks_to_close(const Request& request) {
    const std::string wishes = api::lower_case(combined_field(request, "connection").value_or(""));
    for (std::string_view rest = wishes; !rest.empty();)
        if (api::take_part(rest, ',') == "close") return true;
    return false;
}

bool brings_body(const Request& request) {
    return request.header("content-length").value_or("0") != "0";
}

bool awaits_invitation(const Request& request) {
    return brings_body(request) && expectations(request).find(kInvitation) != std::string::npos;
}

std::optional<Problem> check_request_head(const Request& request, const Limits& limits) {
    if (request.path.size() > kMaxPathBytes) {
        return Problem{ProblemType::PathTooLong,
                       "The path is longer than " + std::to_string(kMaxPathBytes) + " bytes.",
                       {}};
    }
    if (request.header("transfer-encoding")) {
        return Problem{ProblemType::LengthRequired,
                       "Transfer-Encoding is not read here: send a Content-Length instead (with "
                       "curl, -H 'Transfer-Encoding:' or a body from a file).",
                       {}};
    }
    if (request.header("content-encoding")) {
        return Problem{ProblemType::UnsupportedEncoding,
                       "Compressed bodies are not read here: send the body as it is.",
                       {}};
    }
    if (const auto range = request.header("range");
        range &&
        (range->find(',') != std::string_view::npos || count_headers(request, "range") > 1)) {
        return Problem{ProblemType::RangeRefused, "Ask for one range, or for the whole.", {}};
    }
    if (count_headers(request, "host") > 1) {
        return Problem{ProblemType::BadRequest, "Send one Host header.", {}};
    }
    if (auto problem = check_length(request, limits)) return problem;
    return check_expectations(request);
}

}  // namespace tinsmith::server
