// SPDX-License-Identifier: Apache-2.0
// How a session's changes are logged, and made again of the log.
#include <utility>

#include "server/mesh_digest.hpp"
#include "server/session.hpp"

namespace tinsmith::server {

SessionImage Session::image() const {
    const auto lock = lock_to_read();
    return {facts_, tin_, history_, next_polygon_, digest_};
}

void Session::start_log(std::shared_ptr<ChangeLog> log) {
    log_ = std::move(log);
    if (digest_.empty()) digest_ = whole_digest(tin_);
}

std::string Session::log_change(const ChangeAsked& asked, std::span<const AppliedPtr> taken,
                                std::span<const AppliedPtr> done, const Stopwatch& watch) const {
    if (digest_.empty()) return {};
    const std::uint64_t made = version() + 1;
    std::string digest = next_digest(digest_, made, tin_, taken, done);
    if (log_) log_->keep({facts_.birth, asked, digest, counts_now(made), watch.seconds()});
    return digest;
}

/// Requires: a lock. What the history holds is as of the change before.
SessionCounts Session::counts_now(std::uint64_t version) const {
    SessionCounts counts;
    counts.version = version;
    counts.vertices = tin_.vertex_count();
    counts.triangles = tin_.triangle_count();
    counts.bounds = tin_.bounds();
    counts.polygons = history_.polygon_count();
    counts.mesh_bytes = tin_.memory_bytes();
    counts.memory_bytes = counts.mesh_bytes + history_.memory_bytes();
    return counts;
}

SessionCounts Session::counts() const {
    const std::lock_guard lock(view_mutex_);
    return {view_.version,  view_.vertices,     view_.triangles, view_.bounds,
            view_.polygons, view_.memory_bytes, mesh_bytes_};
}

std::optional<std::string> Session::repeat(const ChangeAsked& asked, std::uint64_t version,
                                           std::string_view digest) {
    const auto told = [](const ChangeOutcome& outcome) -> std::string {
        if (std::holds_alternative<ChangeResult>(outcome)) return {};
        return "cannot be done again";
    };
    const Stopwatch watch;
    RunLimits limits;  // none, but the times that reports tell are those of this run
    limits.clock_ms = [&watch] { return watch.seconds() * 1e3; };
    std::string fault;
    if (const auto* perform_it = std::get_if<PerformAsked>(&asked)) {
        const auto lock = lock_to_write();
        const auto applied =
            perform(perform_it->operation, perform_it->kind, perform_it->polygons, limits);
        if (!applied) fault = applied.errors().front().detail;
        if (perform_it->kind == ChangeKind::Polygons) next_polygon_ += perform_it->polygons.size();
        refresh_view();
    } else if (std::holds_alternative<UndoAsked>(asked)) {
        fault = told(undo({}));
    } else if (std::holds_alternative<RedoAsked>(asked)) {
        fault = told(redo({}));
    } else {
        const auto& removal = std::get<RemovalAsked>(asked);
        fault = told(remove_polygon(removal.polygon, removal.cascade, {}));
    }
    if (fault.empty() && this->version() != version) fault = "makes another version";
    if (fault.empty() && digest_ != digest) fault = "writes other bytes than it did";
    if (fault.empty()) return std::nullopt;
    return "The change that made version " + std::to_string(version) + " " + fault + ".";
}

}  // namespace tinsmith::server
