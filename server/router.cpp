// SPDX-License-Identifier: Apache-2.0
#include "server/router.hpp"

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

#include "server/log.hpp"
#include "server/metrics/metrics.hpp"
#include "server/reply.hpp"
#include "server/session_vault.hpp"
#include "server/target.hpp"

namespace tinsmith::server {

namespace {

bool is_argument(std::string_view segment) {
    return segment.starts_with('{');
}

bool matches(const std::vector<std::string>& pattern, const std::vector<std::string>& path) {
    return std::equal(pattern.begin(), pattern.end(), path.begin(), path.end(),
                      [](const std::string& want, const std::string& have) {
                          return is_argument(want) ? !have.empty() : want == have;
                      });
}

PathArguments arguments_of(const std::vector<std::string>& pattern,
                           const std::vector<std::string>& path) {
    PathArguments arguments;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (is_argument(pattern[i])) arguments.push_back(path[i]);
    }
    return arguments;
}

std::string joined(std::span<const std::string_view> words) {
    std::string out;
    for (const std::string_view word : words) {
        if (!out.empty()) out += ", ";
        out += word;
    }
    return out;
}

/// All faults of the query at once; empty: none.
api::Faults query_faults(const Request& request, std::span<const std::string_view> known) {
    api::Faults faults;
    const auto& query = request.query;
    for (std::size_t i = 0; i < query.size() && faults.size() < api::kMaxFaults; ++i) {
        const std::string& name = query[i].first;
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            faults.push_back({"UNKNOWN_PARAMETER",
                              "\"" + name + "\" is not a parameter here; " +
                                  (known.empty() ? std::string("there are none.")
                                                 : "known are: " + joined(known) + "."),
                              {},
                              {},
                              {},
                              name});
            continue;
        }
        const bool repeated =
            std::any_of(query.begin(), query.begin() + static_cast<std::ptrdiff_t>(i),
                        [&name](const NameValue& earlier) { return earlier.first == name; });
        if (repeated) {
            faults.push_back(
                {"REPEATED_PARAMETER", "\"" + name + "\" is given twice.", {}, {}, {}, name});
        }
    }
    return faults;
}

}  // namespace

Router::Router(std::vector<Route> routes, Metrics* metrics) {
    for (Route& route : routes) {
        auto segments = split_path(route.pattern).value_or(std::vector<std::string>{});
        const RouteMeter* const meter = metrics ? &metrics->route(route.pattern) : nullptr;
        entries_.push_back({std::move(route), std::move(segments), meter});
    }
}

Response answer_safely(const Request& request, const std::function<Response()>& answer) {
    try {
        return answer();
    } catch (const std::bad_alloc&) {
        return refuse(request, api::ProblemType::OutOfMemory,
                      "The server has no memory left for this; nothing was changed. Delete "
                      "sessions that are not needed, or send less.");
    } catch (const StorageFault&) {
        return refuse(request, api::ProblemType::StorageUnavailable,
                      "Nothing was changed: what was asked for cannot be stored now. GET /readyz "
                      "and the server's log say why. Ask again in a moment.")
            .with("Retry-After", "2");
    } catch (const SessionIsDamaged& damaged) {
        return refuse(request, api::ProblemType::SessionOutOfService,
                      std::string(damaged.what()) +
                          " Other sessions are not touched by it. DELETE this one, or restore a "
                          "backup.");
    } catch (const SessionIsReadOnly& read_only) {
        return refuse(request, api::ProblemType::SessionReadOnly, read_only.what());
    } catch (const SessionIsGone&) {
        return refuse(request, api::ProblemType::NoSuchSession,
                      "The session was deleted while the request ran: nothing of it is kept.");
    } catch (const std::exception& error) {
        log_event(LogLevel::Error, "defect", "a handler failed",
                  {{"what", error.what()}, {"request", request.id}});
        return refuse(request, api::ProblemType::Internal,
                      "A defect of the server, not of the request. Report it with the request "
                      "id; the log has the details.");
    }
}

Response Router::handle(const Request& request) const {
    const RouteMeter* route = nullptr;
    Response response = answer_safely(request, [&] {
        Way way = way_of(request);
        route = way.meter;
        return way.entry ? way.entry->route.handler(request, way.arguments)
                         : std::move(way.instead);
    });
    response.with("X-Request-Id", request.id);
    response.route = route;  // of this request, where the answer is that of another
    return response;
}

std::optional<Response> Router::refusal_of(const Request& head) const {
    Way way = way_of(head);
    if (way.entry) return std::nullopt;
    way.instead.route = way.meter;
    return std::move(way.instead);
}

std::vector<const Router::Entry*> Router::entries_at(
    const std::vector<std::string>& segments) const {
    std::vector<const Entry*> found;
    for (const Entry& entry : entries_) {
        if (matches(entry.segments, segments)) found.push_back(&entry);
    }
    return found;
}

Router::Way Router::way_of(const Request& request) const {
    Way way;
    const auto segments = split_path(request.path);
    const auto entries = segments ? entries_at(*segments) : std::vector<const Entry*>{};
    if (entries.empty()) {
        way.instead = refuse(request, api::ProblemType::NoSuchPath,
                             "Nothing is served at this path. The sessions are at /v1/sessions.");
        return way;
    }
    way.meter = entries.front()->meter;
    const std::string wanted = request.method == "HEAD" ? "GET" : request.method;
    std::string allow = "OPTIONS";
    for (const Entry* entry : entries) {
        if (entry->route.method == wanted) {
            way.meter = entry->meter;
            auto faults = query_faults(request, entry->route.parameters);
            if (faults.empty()) {
                way.entry = entry;
                way.arguments = arguments_of(entry->segments, *segments);
                return way;
            }
            std::string detail = faults.front().detail;
            way.instead = refuse(request, {api::ProblemType::UnknownParameter, std::move(detail),
                                           std::move(faults)});
            return way;
        }
        allow += ", " + entry->route.method;
        if (entry->route.method == "GET") allow += ", HEAD";
    }
    way.instead = request.method == "OPTIONS" ? ok({}, {})
                                              : refuse(request, api::ProblemType::MethodNotAllowed,
                                                       "This path answers to: " + allow + ".");
    way.instead.with("Allow", allow);
    return way;
}

}  // namespace tinsmith::server
