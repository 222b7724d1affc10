// SPDX-License-Identifier: Apache-2.0
#include "server/config_quotas.hpp"

#include <cstddef>
#include <optional>

#include <CLI/CLI.hpp>

#include "server/config_flags.hpp"

namespace tinsmith::server {

void add_quotas(CLI::App& app, KeyQuotas& quotas) {
    struct QuotaFlag {
        const char* name = nullptr;
        std::optional<std::size_t>* value = nullptr;
        const char* text = nullptr;
        bool is_bytes = false;
    };
    const QuotaFlag flags[] = {
        {"max_sessions", &quotas.max_sessions, "Sessions of the key"},
        {"max_memory_bytes", &quotas.max_memory_bytes,
         "Of its sessions, in memory or not (256MB, 1GB)", true},
        {"max_session_bytes", &quotas.max_session_bytes, "Of each of its sessions", true},
        {"max_requests", &quotas.max_requests, "Requests of the key at the same time"},
        {"max_body_bytes", &quotas.max_body_bytes, "Largest request body", true},
        {"max_vertices", &quotas.max_vertices, "Vertices of a terrain"},
        {"max_triangles", &quotas.max_triangles, "Triangles of a session"},
        {"max_polygon_vertices", &quotas.max_polygon_vertices, "Positions in one request"},
        {"max_crossings", &quotas.max_crossings, "Edges crossed by one request"},
        {"max_history", &quotas.max_history, "Operations that each of its sessions can take back"},
        {"max_history_bytes", &quotas.max_history_bytes, "What they may hold, for one session",
         true},
        {"max_points", &quotas.max_points, "Points of one question for elevations"},
        {"max_profile_crossings", &quotas.max_profile_crossings, "Edges crossed by one profile"},
        {"max_queued_jobs", &quotas.max_queued_jobs, "Jobs of the key that wait for a thread"},
    };
    for (const QuotaFlag& flag : flags) {
        CLI::Option* const option = app.add_option(flag_of(flag.name), *flag.value, flag.text);
        if (flag.is_bytes) option->transform(CLI::AsSizeValue(false));
        option->transform(digit_first());
        if (flag.value == &quotas.max_history) option->check(CLI::PositiveNumber);
    }
    app.add_option("--max-requests-per-second", quotas.max_requests_per_second,
                   "Requests that it may begin in a second")
        ->check(digit_first())
        ->check(CLI::PositiveNumber);
    app.add_option("--max-edit-seconds", quotas.max_edit_seconds, "Time for one edit")
        ->check(digit_first())
        ->check(CLI::PositiveNumber);
}

}  // namespace tinsmith::server
