// SPDX-License-Identifier: Apache-2.0
#include "server/session.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "core/regions/constraint_history.hpp"
#include "server/draping.hpp"

namespace tinsmith::server {

namespace {

std::vector<std::string> new_ids(std::uint64_t first, std::size_t count) {
    std::vector<std::string> ids;
    ids.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        ids.push_back("p" + std::to_string(first + i));
    return ids;
}

/// The caller's budget, tightened to what the session may still grow by.
RunLimits limits_of(const PolygonEdit& edit, const SessionSize& now) {
    RunLimits limits;
    limits.cancelled = edit.options.cancelled;
    limits.clock_ms = edit.options.clock_ms;
    limits.progress = edit.options.progress;
    limits.max_crossings = edit.options.max_crossings;
    limits.max_new_triangles = edit.options.max_new_triangles;
    return tightened(std::move(limits), now, edit.most);
}

/// The edit as it is kept. Its budgets stay behind.
OperationPtr operation_of(PolygonEdit& edit, std::vector<std::string> ids) {
    core::IntegrateOptions options = edit.options;
    const core::IntegrateOptions free;
    options.cancelled = nullptr;
    options.clock_ms = nullptr;
    options.progress = nullptr;
    options.max_crossings = free.max_crossings;
    options.max_new_triangles = free.max_new_triangles;
    return std::make_shared<const Operation>(
        PolygonsOperation{std::move(edit.shapes), std::move(edit.origins), std::move(ids),
                          edit.winding, std::move(options)});
}

}  // namespace

api::SessionView view_of(const SessionFacts& facts, const SessionCounts& counts) {
    api::SessionView view;
    view.id = facts.id;
    view.name = facts.name;
    view.crs = facts.crs;
    view.unit = facts.unit;
    view.repairs = facts.repairs;
    view.notes = facts.notes;
    view.version = counts.version;
    view.vertices = counts.vertices;
    view.triangles = counts.triangles;
    view.bounds = counts.bounds;
    view.polygons = counts.polygons;
    view.memory_bytes = counts.memory_bytes;
    return view;
}

Session::Session(SessionFacts facts, core::Tin tin, HistoryLimits limits)
    : facts_(std::move(facts)),
      tin_(std::move(tin)),
      history_(limits, tin_.vertex_count(), tin_.triangle_count()),
      view_(view_of(facts_, {})) {
    refresh_view();
}

Session::Session(SessionImage image)
    : facts_(std::move(image.facts)),
      tin_(std::move(image.tin)),
      history_(std::move(image.history)),
      next_polygon_(image.next_polygon),
      digest_(std::move(image.digest)),
      view_(view_of(facts_, {})) {
    refresh_view();
}

std::shared_ptr<Session> Session::fork(std::string id, std::string birth) const {
    const auto lock = lock_to_read();
    SessionFacts facts = facts_;
    facts.id = std::move(id);
    facts.birth = std::move(birth);
    auto copy = std::make_shared<Session>(std::move(facts), tin_);
    copy->history_ = history_;
    copy->next_polygon_ = next_polygon_;
    copy->digest_ = digest_;
    copy->refresh_view();
    return copy;
}

std::string Session::etag(std::uint64_t version) const {
    return '"' + facts_.birth + '-' + std::to_string(version) + '"';
}

api::SessionView Session::view() const {
    const std::lock_guard lock(view_mutex_);
    return view_;
}

MeshCopy Session::copy_mesh() const {
    const auto lock = lock_to_read();
    return {tin_.to_data(), version()};
}

core::Tin Session::copy_tin() const {
    const auto lock = lock_to_read();
    return tin_;
}

std::size_t Session::mesh_bytes() const {
    const std::lock_guard lock(view_mutex_);
    return mesh_bytes_;
}

DrapedCopy Session::draped(std::optional<std::string_view> id) const {
    const auto lock = lock_to_read();
    DrapedCopy copy{{}, version()};
    std::vector<Polygon> wanted;
    for (const Polygon& polygon : history_.polygons()) {
        if (!id || polygon.id() == *id) wanted.push_back(polygon);
    }
    if (wanted.empty()) return copy;
    const core::ConstraintHistory splits(tin_);
    for (const Polygon& polygon : wanted)
        copy.polygons.push_back(drape(tin_, splits, polygon));
    return copy;
}

// A shared mutex alone lets a stream of readers keep a writer out for ever.
std::shared_lock<std::shared_mutex> Session::lock_to_read() const {
    const std::lock_guard turn(turn_);
    return std::shared_lock(mutex_);
}

std::unique_lock<std::shared_mutex> Session::lock_to_write() const {
    const std::lock_guard turn(turn_);
    return std::unique_lock(mutex_);
}

/// Requires: the writer's lock, or nobody else about.
void Session::refresh_view() noexcept {
    const std::lock_guard lock(view_mutex_);
    view_.version = version();
    view_.vertices = tin_.vertex_count();
    view_.triangles = tin_.triangle_count();
    view_.bounds = tin_.bounds();
    view_.polygons = history_.polygon_count();
    mesh_bytes_ = tin_.memory_bytes();
    view_.memory_bytes = mesh_bytes_ + history_.memory_bytes();
}

SessionSize Session::size_now() const {
    return {tin_.triangle_count(), tin_.memory_bytes() + history_.memory_bytes()};
}

core::Result<AppliedPtr> Session::perform(OperationPtr operation, ChangeKind kind,
                                          std::vector<std::string> polygons,
                                          const RunLimits& limits) {
    require_whole();
    // Memory first: once the mesh has changed, nothing may fail before it is on record.
    const std::uint64_t made = version() + 1;
    Edit step;
    step.version = made;
    step.first = history_.base() + history_.applied().size();
    step.added.push_back({made, operation});
    step.polygons = polygons;
    std::vector<AppliedPtr> done(1);
    Change change;
    change.version = made;
    change.kind = kind;
    change.polygons = std::move(polygons);
    change.step = Exchange{step.first, {}, step.added};
    change.written.resize(1);
    history_.prepare(1);
    history_.bound({most_operations_, most_history_bytes_});
    const Stopwatch watch;
    auto applied = run(tin_, made, std::move(operation), limits, polygon_finder());
    if (!applied) return applied;
    if (kind == ChangeKind::Polygons) change.report = (*applied)->report;
    change.locks = (*applied)->locks;
    change.answer = (*applied)->answer;
    change.vertices = tin_.vertex_count();
    change.triangles = tin_.triangle_count();
    change.written[0] = (*applied)->written;
    step.added_bytes = (*applied)->lasting_bytes;
    done[0] = *applied;
    try {
        digest_ =
            log_change(PerformAsked{kind, (*applied)->operation, change.polygons}, {}, done, watch);
    } catch (...) {
        is_lost_ = !taken_back((*applied)->undo);
        throw;
    }
    history_.make(std::move(step), std::move(done), std::move(change));
    return applied;
}

/// Without an exception. False: the mesh is now neither what it was nor what it became.
bool Session::taken_back(const core::Undo& undo) noexcept {
    try {
        core::take_back(tin_, undo);
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

PolygonFinder Session::polygon_finder() const {
    return [this](std::string_view id) -> std::optional<Polygon> {
        for (const Polygon& polygon : history_.polygons())
            if (polygon.id() == id) return polygon;
        return std::nullopt;
    };
}

PolygonOutcome Session::integrate(PolygonEdit edit) {
    if (edit.dry_run) return integrate_dry(edit);
    const auto lock = lock_to_write();
    const std::uint64_t before = version();
    if (!is_expected(edit, before)) return VersionMismatch{before};
    const RunLimits limits = limits_of(edit, size_now());
    PolygonResult result;
    result.version = before + 1;
    result.polygon_ids = new_ids(next_polygon_, edit.shapes.size());
    const auto applied = perform(operation_of(edit, result.polygon_ids), ChangeKind::Polygons,
                                 result.polygon_ids, limits);
    if (!applied) return named_by(limits, applied.errors());
    result.report = (*applied)->report;
    next_polygon_ += result.polygon_ids.size();
    refresh_view();
    if (edit.want_mesh) result.mesh = mesh_if_possible();
    if (edit.want_delta) result.delta = delta_if_possible(before);
    if (edit.want_angles) result.angles = angles_if_possible((*applied)->undo);
    return result;
}

/// The edit is made by now: want of memory must not look as if it had failed.
std::optional<core::MeshData> Session::mesh_if_possible() const {
    try {
        return tin_.to_data();
    } catch (const std::bad_alloc&) {
        return std::nullopt;
    }
}

std::optional<core::AngleCounts> Session::angles_if_possible(const core::Undo& undo) const {
    try {
        return core::count_angles(tin_, undo);
    } catch (const std::bad_alloc&) {
        return std::nullopt;
    }
}

PolygonOutcome Session::integrate_dry(const PolygonEdit& edit) const {
    auto lock = lock_to_read();
    if (!is_expected(edit, version())) return VersionMismatch{version()};
    core::Tin trial = tin_;
    const RunLimits limits = limits_of(edit, size_now());
    PolygonResult result;
    result.version = version();
    result.polygon_ids = new_ids(next_polygon_, edit.shapes.size());
    lock.unlock();
    core::IntegrateOptions options = edit.options;
    options.max_new_triangles = limits.max_new_triangles;
    core::Undo undo;
    auto report = core::integrate(trial, edit.shapes, options, edit.want_angles ? &undo : nullptr);
    if (!report) return named_by(limits, std::move(report.errors()));
    if (edit.want_angles) result.angles = core::count_angles(trial, undo);
    result.report = std::make_shared<core::Report>(std::move(*report));
    if (edit.want_mesh) result.mesh = trial.to_data();
    return result;
}

}  // namespace tinsmith::server
