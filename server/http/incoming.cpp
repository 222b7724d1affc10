// SPDX-License-Identifier: Apache-2.0
#include "server/http/incoming.hpp"

#include <utility>

#include "server/entity_tag.hpp"
#include "server/limits.hpp"
#include "server/log.hpp"
#include "server/random_id.hpp"
#include "server/target.hpp"

namespace tinsmith::server {

namespace {

/// The sender's trace with a span of our own; nothing where there is none, or none valid. Repeated
/// headers are not valid together.
std::optional<TraceContext> trace_of(const Request& request) {
    auto trace = parse_traceparent(combined_field(request, "traceparent").value_or(""));
    if (trace) trace->parent_id = random_hex(trace->parent_id.size() / 2);
    return trace;
}

}  // namespace

Head read_head(std::string method, std::string_view version, const std::string& target,
               std::vector<NameValue> headers) {
    Head head;
    Request& request = head.request;
    request.method = std::move(method);
    request.headers = std::move(headers);
    if (version == "HTTP/1.1" && !request.header("host")) head.fault = "Send a Host header.";
    const auto wished_id = request.header("x-request-id");
    request.id = wished_id && is_sane_id(*wished_id) ? std::string(*wished_id) : random_hex(8);
    request.trace = trace_of(request);
    request.path = target.substr(0, target.find_first_of("?#"));
    if (request.path.size() > kMaxPathBytes) return head;  // the guard says so
    auto parsed = parse_target(target);
    if (!parsed) {
        head.fault =
            "The target must be a path that begins with \"/\", with no broken %-escape and no "
            "control character in it or its query.";
    } else if (parsed->query.size() > kMaxQueryParameters) {
        head.fault = "Too many query parameters.";
    } else {
        request.query = std::move(parsed->query);
    }
    return head;
}

}  // namespace tinsmith::server
