// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "api/responses.hpp"
#include "server/keys/key_file.hpp"
#include "server/metrics/families.hpp"
#include "server/metrics/scrape.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"

namespace tinsmith::server {

namespace {

/// 503, with what is in the way. Requires: something is.
Response refuse_unready(const Request& request, const std::vector<Readiness::Refusal>& refusals) {
    api::Problem problem{api::ProblemType::NotReady, "Not ready", {}};
    for (const auto& [code, why] : refusals) {
        problem.detail += (problem.errors.empty() ? ": " : "; ") + why;
        if (problem.errors.size() < api::kMaxFaults) problem.errors.push_back({code, why, {}});
    }
    problem.detail += ". Ask again in a moment, or another server.";
    return refuse(request, problem).with("Retry-After", "1");
}

}  // namespace

Response get_health(Services&, const Request&, const PathArguments&) {
    return ok(kJson, "{\"status\":\"ok\"}\n");
}

Response get_ready(Services& services, const Request& request, const PathArguments&) {
    const auto refusals = services.readiness.refusals();
    if (refusals.empty()) return ok(kJson, "{\"status\":\"ready\"}\n");
    return refuse_unready(request, refusals);
}

Response get_metrics(Services& services, const Request&, const PathArguments&) {
    return ok(kMetricsMediaType, scrape(services));
}

Handler once_started(Services& services, Handler handler) {
    return [&services, handler = std::move(handler)](const Request& request,
                                                     const PathArguments& arguments) {
        // One that is told to stop while it starts never knows its sessions, nor which requests it
        // has answered before.
        if (services.readiness.has_started()) return handler(request, arguments);
        return refuse_unready(request, services.readiness.refusals());
    };
}

Response get_limits(Services& services, const Request& request, const PathArguments&) {
    const Limits& limits = services.limits;
    const std::array<std::pair<std::string_view, double>, 22> list{{
        {"max_body_bytes", static_cast<double>(limits.max_body_bytes)},
        {"max_sessions", static_cast<double>(limits.max_sessions)},
        {"max_memory_bytes", static_cast<double>(limits.max_memory_bytes)},
        {"max_session_bytes", static_cast<double>(limits.max_session_bytes)},
        {"max_vertices", static_cast<double>(limits.max_vertices)},
        {"max_triangles", static_cast<double>(limits.max_triangles)},
        {"max_polygon_vertices", static_cast<double>(limits.max_polygon_vertices)},
        {"max_history", static_cast<double>(limits.max_history)},
        {"max_history_bytes", static_cast<double>(limits.max_history_bytes)},
        {"max_crossings", static_cast<double>(limits.max_crossings)},
        {"max_edit_seconds", limits.max_edit_seconds},
        {"max_requests", static_cast<double>(limits.max_requests)},
        {"max_points", static_cast<double>(limits.max_points)},
        {"max_profile_crossings", static_cast<double>(limits.max_profile_crossings)},
        {"job_threads", static_cast<double>(limits.job_threads)},
        {"max_jobs", static_cast<double>(limits.max_jobs)},
        {"max_queued_jobs", static_cast<double>(limits.max_queued_jobs)},
        {"job_bytes", static_cast<double>(limits.job_bytes)},
        {"job_seconds", static_cast<double>(limits.job_seconds)},
        {"mesh_cache", static_cast<double>(limits.mesh_cache)},
        {"session_ttl", static_cast<double>(limits.session_ttl)},
        {"kept_answers", static_cast<double>(limits.kept_answers)},
    }};
    std::optional<api::KeyView> key;
    if (const Asker& asker = request.asker; !asker.id.empty()) {
        key = {asker.name, asker.id, {}};
        for (const auto& [name, value] : named_quotas(asker.quotas))
            if (value) key->quotas.emplace_back(name, *value);
    }
    return ok(kJson, api::write_limits(list, key));
}

}  // namespace tinsmith::server
