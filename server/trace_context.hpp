// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tinsmith::server {

/// Where a request belongs among those that its sender follows (W3C Trace Context, version 00).
struct TraceContext {
    std::string trace_id;   ///< 32 lower-case hexadecimal digits, not all zero
    std::string parent_id;  ///< 16 of them, not all zero
    std::string flags;      ///< 2 of them

    std::string text() const { return "00-" + trace_id + "-" + parent_id + "-" + flags; }
};

/// Nothing but a valid header of version 00, to the letter: what comes out is safe to log and send.
std::optional<TraceContext> parse_traceparent(std::string_view text);

}  // namespace tinsmith::server
