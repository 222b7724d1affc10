// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/scrape.hpp"

#include <iterator>
#include <utility>
#include <vector>

#include <prometheus/metric_family.h>

#include "server/metrics/families.hpp"
#include "server/metrics/process.hpp"

namespace tinsmith::server {

namespace {

using Figures = std::vector<prometheus::MetricFamily>;

void add_process(Figures& all) {
    const ProcessFigures process = process_figures();
    const auto whole = [](std::uint64_t value) { return static_cast<double>(value); };
    all.push_back(gauge("process_start_time_seconds", "When the process began, since 1970.",
                        process.start_seconds));
    all.push_back(counter("process_cpu_seconds_total", "Time on all processors, user and system.",
                          process.cpu_seconds));
    all.push_back(gauge("process_resident_memory_bytes", "Memory that is in RAM.",
                        whole(process.resident_bytes)));
    all.push_back(
        gauge("process_virtual_memory_bytes", "Address space.", whole(process.virtual_bytes)));
    all.push_back(gauge("process_open_fds", "Open files and sockets.", whole(process.open_files)));
    all.push_back(gauge("process_max_fds", "As many may be open.", whole(process.max_files)));
    prometheus::MetricFamily build =
        gauge("tinsmith_build_info", "Always 1; the program's version.", 0.0);
    build.metric.clear();
    add_series(build, {"version", TINSMITH_VERSION}, 1.0);
    all.push_back(std::move(build));
}

void add_sessions(Figures& all, const Services& services) {
    const SessionTotals totals = services.sessions.totals();
    const auto whole = [](std::size_t value) { return static_cast<double>(value); };
    all.push_back(
        gauge("tinsmith_sessions", "Sessions, in memory and stored.", whole(totals.sessions)));
    all.push_back(gauge("tinsmith_sessions_in_memory", "Those of them that are in memory.",
                        whole(totals.in_memory)));
    all.push_back(gauge("tinsmith_sessions_out_of_service", "Those that cannot be read.",
                        whole(totals.out_of_service)));
    all.push_back(gauge("tinsmith_sessions_max", "The limit max_sessions.",
                        whole(services.limits.max_sessions)));
    all.push_back(
        gauge("tinsmith_session_triangles", "Triangles of all sessions.", whole(totals.triangles)));
    all.push_back(gauge("tinsmith_session_memory_bytes",
                        "Meshes and histories of all sessions, and copies under way.",
                        whole(totals.memory_bytes)));
    all.push_back(gauge("tinsmith_session_memory_max_bytes", "The limit max_memory_bytes.",
                        whole(services.limits.max_memory_bytes)));
}

void add_caches(Figures& all, const Services& services) {
    const MeshCache::Counts meshes = services.meshes.counts();
    const auto whole = [](std::uint64_t value) { return static_cast<double>(value); };
    all.push_back(counter("tinsmith_mesh_cache_hits_total", "Meshes sent that were encoded before.",
                          whole(meshes.hits)));
    all.push_back(counter("tinsmith_mesh_cache_misses_total", "Meshes that had to be encoded.",
                          whole(meshes.encodings)));
    all.push_back(
        gauge("tinsmith_mesh_cache_bytes", "Encoded meshes that are kept.", whole(meshes.bytes)));
    all.push_back(gauge("tinsmith_kept_answers", "Answers that are kept for retries by key.",
                        whole(services.answers.size())));
    all.push_back(
        gauge("tinsmith_kept_answers_bytes", "What they hold.", whole(services.answers.bytes())));
}

void add_work(Figures& all, Services& services) {
    const Jobs::Counts jobs = services.jobs.counts();
    all.push_back(
        gauge("tinsmith_jobs_queued", "Jobs that wait.", static_cast<double>(jobs.queued)));
    all.push_back(
        gauge("tinsmith_jobs_running", "Jobs at work.", static_cast<double>(jobs.running)));
    all.push_back(gauge("tinsmith_ready", "1 where /readyz says so, else 0.",
                        services.readiness.refusals().empty() ? 1.0 : 0.0));
}

void add_journal(Figures& all, const Services& services) {
    if (!services.vault) return;
    const JournalFigures figures = services.vault->journal().figures();
    const auto whole = [](std::uint64_t value) { return static_cast<double>(value); };
    all.push_back(counter("tinsmith_journal_commits_total", "Commits that the disk has.",
                          whole(figures.commits)));
    all.push_back(
        counter("tinsmith_journal_entries_total", "Changes in them.", whole(figures.entries)));
    all.push_back(counter("tinsmith_journal_failures_total", "Commits that did not come about.",
                          whole(figures.failures)));
    all.push_back(counter("tinsmith_journal_written_bytes_total", "Of changes and snapshots.",
                          whole(figures.written_bytes)));
    all.push_back(gauge("tinsmith_journal_queued_entries", "Changes that wait for a commit.",
                        whole(figures.queued_entries)));
    all.push_back(gauge("tinsmith_journal_file_bytes", "The database.", whole(figures.file_bytes)));
    all.push_back(
        gauge("tinsmith_journal_log_bytes", "Its write-ahead log.", whole(figures.log_bytes)));
    all.push_back(histogram("tinsmith_journal_commit_seconds", "Write and sync of a commit.",
                            JournalFigures::kSeconds, figures.commits_within,
                            figures.commit_seconds));
}

}  // namespace

std::string scrape(Services& services) {
    Figures all = services.metrics.collect();
    add_process(all);
    add_sessions(all, services);
    add_caches(all, services);
    add_work(all, services);
    add_journal(all, services);
    sort(all);
    return text_of(all);
}

}  // namespace tinsmith::server
