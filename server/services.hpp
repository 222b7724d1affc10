// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <utility>

#include "api/formats/read_limits.hpp"
#include "server/jobs.hpp"
#include "server/kept_answers.hpp"
#include "server/keys/asker.hpp"
#include "server/limits.hpp"
#include "server/mesh_cache.hpp"
#include "server/metrics/metrics.hpp"
#include "server/page_files.hpp"
#include "server/policy.hpp"
#include "server/readiness.hpp"
#include "server/session_store.hpp"
#include "server/session_vault.hpp"

namespace tinsmith::server {

/// What the handlers of one process share.
struct Services {
    /// No vault: sessions live in memory alone.
    explicit Services(const Limits& the_limits, Policy the_policy = {},
                      std::unique_ptr<SessionVault> the_vault = nullptr)
        : limits(the_limits),
          policy(std::move(the_policy)),
          vault(std::move(the_vault)),
          sessions(the_limits, vault.get()),
          meshes(the_limits.mesh_cache),
          answers({.bytes = the_limits.kept_answers}),
          jobs({the_limits.job_threads, the_limits.max_queued_jobs, the_limits.max_jobs,
                the_limits.job_bytes, std::chrono::seconds(the_limits.job_seconds)}) {}

    /// What holds for who asks.
    Limits limits_of(const Asker& asker) const { return within_quotas(limits, asker.quotas); }
    api::ReadLimits read_limits(const Asker& asker = {}) const {
        const Limits all = limits_of(asker);
        api::ReadLimits read;
        read.max_vertices = all.max_vertices;
        read.max_triangles = all.max_triangles;
        read.max_polygon_vertices = all.max_polygon_vertices;
        read.progress = reading_progress();
        return read;
    }

    /// Drops what is kept beside a session that has been removed.
    void forget(const Session& session) {
        meshes.forget(session.facts().birth);
        answers.forget(session.facts().birth);
    }

    const Limits limits;
    const Policy policy;
    Metrics metrics;      ///< what is added to it may look at all of the below
    Readiness readiness;  ///< likewise
    PageFiles page;       ///< set before the first request, if at all
    const std::unique_ptr<SessionVault> vault;  ///< null: none; outlives what is stored in it
    SessionStore sessions;
    MeshCache meshes;                   ///< encoded
    KeptAnswers answers;                ///< for retries by key
    std::atomic<bool> stopping{false};  ///< edits under way give up when it turns true
    /// Called once when the server stops, on one thread: no request is under way any more, nor a
    /// job. Sessions are snapshotted here, as many as there is time for until then; what comes
    /// later ends with the process.
    std::function<void(std::chrono::steady_clock::time_point until)> before_exit;
    Jobs jobs;  ///< last: their work uses all of the above
};

}  // namespace tinsmith::server
