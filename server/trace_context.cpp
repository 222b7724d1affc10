// SPDX-License-Identifier: Apache-2.0
#include "server/trace_context.hpp"

namespace tinsmith::server {

namespace {

bool is_hex(std::string_view text) {
    return text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_id(std::string_view text) {
    return is_hex(text) && text.find_first_not_of('0') != std::string_view::npos;
}

}  // namespace

std::optional<TraceContext> parse_traceparent(std::string_view text) {
    //  00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01
    //  0  3                               36               53
    static constexpr std::size_t kLength = 55;
    if (text.size() != kLength || !text.starts_with("00-")) return std::nullopt;
    if (text[35] != '-' || text[52] != '-') return std::nullopt;
    const std::string_view trace = text.substr(3, 32);
    const std::string_view parent = text.substr(36, 16);
    const std::string_view flags = text.substr(53);
    if (!is_id(trace) || !is_id(parent) || !is_hex(flags)) return std::nullopt;
    return TraceContext{std::string(trace), std::string(parent), std::string(flags)};
}

}  // namespace tinsmith::server
