// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/http_message.hpp"

namespace tinsmith::server {

class Metrics;

/// What stood in the path where the pattern has "{...}", in order.
using PathArguments = std::vector<std::string>;

using Handler = std::function<Response(const Request&, const PathArguments&)>;

/// What `answer` gives; where it throws, a 500 (507 when memory ran out) that tells nothing of the
/// exception.
Response answer_safely(const Request& request, const std::function<Response()>& answer);

/// One line of the route table.
struct Route {
    std::string method;
    std::string pattern;                             ///< "/v1/sessions/{id}/mesh"
    std::span<const std::string_view> parameters{};  ///< query parameters it knows
    Handler handler;
};

/// Finds the handler of a request and calls it.
///
/// Laws: a path nobody has is 404; a method the path does not have is 405 with Allow; HEAD is
/// answered as GET (the transport drops the body) and OPTIONS with Allow; unknown and repeated
/// query parameters are refused by name; a handler that throws makes a 500 (507 when memory ran
/// out) that tells nothing of the exception; every answer carries X-Request-Id.
/// No regular expressions: matching is linear in the path.
class Router {
  public:
    /// With `metrics`, which outlives it, answers say which pattern they are counted by.
    explicit Router(std::vector<Route> routes, Metrics* metrics = nullptr);

    Response handle(const Request& request) const;

    /// What `handle` would answer without asking a handler, whatever the body; nothing: a handler
    /// answers. Without X-Request-Id.
    std::optional<Response> refusal_of(const Request& head) const;

  private:
    struct Entry {
        Route route;
        std::vector<std::string> segments;
        const RouteMeter* meter = nullptr;
    };

    /// Where a request goes.
    struct Way {
        const Entry* entry = nullptr;  ///< null: nowhere, and `instead` is the answer
        PathArguments arguments;
        Response instead;
        const RouteMeter* meter = nullptr;  ///< of the path, if it has one
    };

    Way way_of(const Request& request) const;
    std::vector<const Entry*> entries_at(const std::vector<std::string>& segments) const;

    std::vector<Entry> entries_;
};

}  // namespace tinsmith::server
