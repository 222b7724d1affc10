// SPDX-License-Identifier: Apache-2.0
#include "server/http/request_head.hpp"

#include <algorithm>
#include <string>

#include "api/field_list.hpp"
#include "server/limits.hpp"

namespace tinsmith::server {

namespace {

using api::Problem;
using api::ProblemType;

/// The library takes an empty line after any line, whatever ended that one.
constexpr std::string_view kHeadEnd = "\n\r\n";

/// Of a header's name, to say which.
constexpr std::size_t kToldOfName = 64;

constexpr std::string_view kRange = "range";
/// The one unit of ranges that is known, as the library wants it.
constexpr std::string_view kBytes = "bytes=";

Problem bad(std::string detail) {
    return {ProblemType::BadRequest, std::move(detail), {}};
}

bool is_control(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\t') || byte == 0x7F;
}

/// A token (RFC 9110 5.6.2): other programs see in a name with a blank the header that it looks
/// like.
bool is_token(std::string_view name) {
    static constexpr std::string_view kOthers = "!#$%&'*+-.^_`|~";
    return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
        const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        return is_letter || (c >= '0' && c <= '9') || kOthers.find(c) != std::string_view::npos;
    });
}

/// Of a request line that is too long, whole or not: what of it is.
Problem target_too_long(std::string_view line) {
    const std::string_view target = line.substr(std::min(line.find(' '), line.size() - 1) + 1);
    if (target.find_first_of(" ?#") <= kMaxPathBytes) {
        return {ProblemType::PathTooLong,
                "The request line, which has the query, is longer than " +
                    std::to_string(kMaxLineBytes) + " bytes.",
                {}};
    }
    return {ProblemType::PathTooLong,
            "The path is longer than " + std::to_string(kMaxPathBytes) + " bytes.",
            {}};
}

/// A method, a target and a version, with one blank between them.
std::optional<Problem> check_request_line(std::string_view line) {
    if (line.size() > kMaxLineBytes) return target_too_long(line);
    const std::size_t method = line.find(' ');
    const std::size_t target = line.rfind(' ');
    if (method == std::string_view::npos || target <= method + 1 ||
        !is_token(line.substr(0, method)) ||
        line.substr(method + 1, target - method - 1).find(' ') != std::string_view::npos)
        return bad("The request line is not a method, a target and a version.");
    const std::string_view version = line.substr(target + 1);
    if (version != "HTTP/1.1" && version != "HTTP/1.0")
        return bad("The request is not HTTP/1.1, which is what is spoken here.");
    return std::nullopt;
}

/// The library passes over a header without a value and decodes %-escapes in one: where the body
/// ends, nobody may read differently.
std::optional<Problem> check_header(std::string_view line) {
    if (line.front() == ' ' || line.front() == '\t')
        return bad("A header goes on in a second line: send it in one.");
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) return bad("A header has no colon.");
    const std::string_view name = line.substr(0, colon);
    if (!is_token(name))
        return bad("A header's name has a blank or another character that none may have.");
    if (line.size() > kMaxLineBytes) {
        return Problem{ProblemType::TooManyHeaders,
                       "The header " + std::string(name.substr(0, kToldOfName)) +
                           " is longer than " + std::to_string(kMaxLineBytes) +
                           " bytes, its name included.",
                       {}};
    }
    const std::string key = api::lower_case(name);
    if (key != "content-length" && key != "transfer-encoding") return std::nullopt;
    const std::string_view value = api::trimmed(line.substr(colon + 1));
    if (value.empty() || value.find('%') != std::string_view::npos)
        return bad("The header " + key + " has no value that can be read.");
    return std::nullopt;
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
        auto problem = lines == 0 ? check_request_line(line) : check_header(line);
        if (problem) return problem;
    }
    if (lines > kMaxHeaders + 1) {
        return Problem{ProblemType::TooManyHeaders,
                       "Send at most " + std::to_string(kMaxHeaders) + " headers.",
                       {}};
    }
    return std::nullopt;
}

std::optional<HeadPart> range_of_other_unit(std::string_view head) {
    for (std::size_t begin = head.find('\n') + 1; begin < head.size();) {
        const std::size_t end = head.find('\n', begin) + 1;
        const std::string_view line = head.substr(begin, end - begin);
        const std::size_t colon = line.find(':');
        if (colon == kRange.size() && api::lower_case(line.substr(0, colon)) == kRange &&
            !api::trimmed(line.substr(colon + 1)).starts_with(kBytes))
            return HeadPart{begin, line.size()};
        begin = end;
    }
    return std::nullopt;
}

Problem head_too_large(std::string_view bytes) {
    if (bytes.find('\n') == std::string_view::npos) return target_too_long(bytes);
    return {ProblemType::TooManyHeaders,
            "The request's head is longer than " + std::to_string(kMaxHeadBytes) + " bytes.",
            {}};
}

}  // namespace tinsmith::server
