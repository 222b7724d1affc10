// SPDX-License-Identifier: Apache-2.0
#include "server/cors.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "api/field_list.hpp"
#include "server/answer_finish.hpp"
#include "server/entity_tag.hpp"

namespace tinsmith::server {

namespace {

constexpr const char* kExposed =
    "ETag, Location, Link, Idempotency-Replayed, X-Request-Id, traceparent, Retry-After, "
    "WWW-Authenticate, "
    "Preference-Applied, Tinsmith-Max-Error, Tinsmith-Triangles, Tinsmith-Flipped-Triangles, "
    "Tinsmith-Collapsed-Triangles, "
    "Tinsmith-Position-Bits, Tinsmith-Origin";

/// Request headers that mean something here, lower-case.
constexpr std::array<std::string_view, 11> kUnderstood{
    "accept", "accept-encoding", "authorization", "content-type", "if-match",  "if-none-match",
    "prefer", "idempotency-key", "x-request-id",  "traceparent",  "tracestate"};

constexpr const char* kPreflightSeconds = "600";

bool contains(const std::vector<std::string>& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

/// Of the headers that the page wants to send, those understood.
std::string headers_for(const Request& request) {
    const auto field = combined_field(request, "access-control-request-headers");
    std::string_view rest = field ? std::string_view(*field) : std::string_view();
    std::string allowed;
    while (!rest.empty()) {
        const std::string name = api::lower_case(api::take_part(rest, ','));
        if (std::find(kUnderstood.begin(), kUnderstood.end(), name) == kUnderstood.end()) continue;
        allowed += (allowed.empty() ? "" : ", ") + name;
    }
    return allowed;
}

void answer_preflight(const Request& request, Response& response) {
    std::string methods;
    for (const auto& [name, value] : response.headers) {
        if (name == "Allow") methods = value;
    }
    if (methods.empty()) return;
    response.with("Access-Control-Allow-Methods", methods)
        .with("Access-Control-Max-Age", kPreflightSeconds);
    const std::string headers = headers_for(request);
    if (!headers.empty()) response.with("Access-Control-Allow-Headers", headers);
    add_vary(response, "Access-Control-Request-Headers");
}

}  // namespace

std::span<const std::string_view> understood_headers() {
    return kUnderstood;
}

std::string_view exposed_headers() {
    return kExposed;
}

void allow_origin(const Policy& policy, const Request& request, Response& response) {
    if (policy.cors_origins.empty()) return;
    const bool for_all = contains(policy.cors_origins, "*");
    if (!for_all) add_vary(response, "Origin");
    const auto origin = request.header("origin");
    if (!origin || !(for_all || contains(policy.cors_origins, *origin))) return;
    response.with("Access-Control-Allow-Origin", for_all ? "*" : std::string(*origin));
    if (request.method == "OPTIONS" && request.header("access-control-request-method")) {
        answer_preflight(request, response);
    } else {
        response.with("Access-Control-Expose-Headers", kExposed);
    }
}

}  // namespace tinsmith::server
