// SPDX-License-Identifier: Apache-2.0
#include "server/http/request_head.hpp"

#include <algorithm>
#include <string>

#include "server/limits.hpp"

namespace tinsmith::server {

namespace {

using api::Problem;
using api::ProblemType;

/// The library takes an empty line after any line, whatever ended that one.
constexpr std::string_view kHeadEnd = "\n\r\n";

Problem bad(std::string detail) {
    return {ProblemType::BadRequest, std::move(detail), {}};
}

bool is_control(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\t') || byte == 0x7F;
}

}  // namespace

std::size_t size_of_head(std::string_view bytes, std::size_t looked_at) {
    const std::size_t from = looked_at < kHeadEnd.size() ? 0 : looked_at - kHeadEnd.size() + 1;
    const std::size_t found = bytes.find(kHeadEnd, from);
    return found == std::string_view::npos ? 0 : found + kHeadEnd.size();
}

std::optional<Problem> check_head_bytes(std::string_view head) {
    std::size_t lines = 0;
    for (std::string_view rest = head; !rest.empty(); ++lines) {
        const std::size_t end = rest.find('\n');
        if (end == std::string_view::npos || end == 0 || rest[end - 1] != '\r')
            return bad("A line of the head does not end with CR LF.");
        const std::string_view line = rest.substr(0, end - 1);
        rest.remove_prefix(end + 1);
        if (line.empty()) break;
        if (std::any_of(line.begin(), line.end(), is_control))
            return bad("The head has a control character.");
        if (lines == 0) continue;
        if (line.front() == ' ' || line.front() == '\t')
            return bad("A header goes on in a second line: send it in one.");
        if (line.find(':') == std::string_view::npos) return bad("A header has no colon.");
    }
    if (lines > kMaxHeaders + 1) {
        return Problem{ProblemType::TooManyHeaders,
                       "Send at most " + std::to_string(kMaxHeaders) + " headers.",
                       {}};
    }
    return std::nullopt;
}

Problem head_too_large(std::string_view bytes) {
    if (bytes.find('\n') == std::string_view::npos) {
        return {ProblemType::PathTooLong,
                "The path is longer than " + std::to_string(kMaxPathBytes) + " bytes.",
                {}};
    }
    return {ProblemType::TooManyHeaders,
            "The request's head is longer than " + std::to_string(kMaxHeadBytes) + " bytes.",
            {}};
}

}  // namespace tinsmith::server
