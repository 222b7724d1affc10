// SPDX-License-Identifier: Apache-2.0
#include "server/session.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "core/regions/constraint_history.hpp"
#include "server/draping.hpp"

namespace tinsmith::server {

namespace {

std::vector<std::string> polygon_ids(std::uint64_t first, std::size_t count) {
    std::vector<std::string> ids;
    ids.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        ids.push_back("p" + std::to_string(first + i));
    return ids;
}

/// The caller's budget, tightened to what the session may still grow by.
core::IntegrateOptions options_for(const PolygonEdit& edit, const core::Tin& tin) {
    core::IntegrateOptions options = edit.options;
    const std::size_t room =
        edit.max_triangles - std::min(edit.max_triangles, tin.triangle_count());
    options.max_new_triangles = std::min<std::uint64_t>(options.max_new_triangles, room);
    return options;
}

/// Room for so many more, growing by a factor as push_back does.
void make_room(std::vector<Polygon>& polygons, std::size_t more) {
    const std::size_t needed = polygons.size() + more;
    if (needed > polygons.capacity()) polygons.reserve(std::max(needed, polygons.capacity() * 2));
}

/// The edit is made by now: want of memory must not look as if it had failed.
std::optional<core::MeshData> copy_if_possible(const core::Tin& tin) {
    try {
        return tin.to_data();
    } catch (const std::bad_alloc&) {
        return std::nullopt;
    }
}

/// Leaves the closed paths, in plan: what says where the inside is.
void keep_outline(core::Shape& shape) noexcept {
    std::erase_if(shape.paths, [](const core::Path& path) { return !path.closed; });
    for (core::Path& path : shape.paths)
        path.elevations = std::vector<double>();  // {} would keep the memory
}

/// About what a polygon holds in memory, its part of the report with it.
std::size_t bytes_of(const Polygon& polygon) {
    std::size_t sum = sizeof polygon + polygon.origin.properties.size() +
                      polygon.origin.client_id.size() +
                      polygon.origin.polygon_starts.size() * sizeof(std::size_t);
    for (const core::Path& path : polygon.outline.paths)
        sum += sizeof path + path.points.size() * sizeof(core::Point2);
    for (const core::Chain& chain : polygon.own_report().chains)
        sum += sizeof chain + chain.vertices.size() * sizeof(core::VertexId);
    for (const core::OutsidePart& part : polygon.own_report().outside)
        sum += sizeof part + part.points.size() * sizeof(core::Point2);
    return sum;
}

bool is_expected(const PolygonEdit& edit, std::uint64_t version) {
    return !edit.expected_version || *edit.expected_version == version;
}

}  // namespace

Session::Session(SessionFacts facts, core::Tin tin)
    : facts_(std::move(facts)), tin_(std::move(tin)) {
    view_.id = facts_.id;
    view_.name = facts_.name;
    view_.crs = facts_.crs;
    view_.unit = facts_.unit;
    refresh_view();
}

std::shared_ptr<Session> Session::fork(std::string id, std::string birth) const {
    const auto lock = lock_to_read();
    SessionFacts facts{std::move(id), std::move(birth), facts_.name, facts_.crs, facts_.unit};
    auto copy = std::make_shared<Session>(std::move(facts), tin_);
    copy->version_ = version_;
    copy->next_polygon_ = next_polygon_;
    copy->polygon_bytes_ = polygon_bytes_;
    copy->polygons_ = polygons_;
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
    return {tin_.to_data(), version_};
}

DrapedCopy Session::draped(std::optional<std::string_view> id) const {
    const auto lock = lock_to_read();
    DrapedCopy copy{{}, version_};
    std::vector<const Polygon*> wanted;
    for (const Polygon& polygon : polygons_) {
        if (!id || polygon.id == *id) wanted.push_back(&polygon);
    }
    if (wanted.empty()) return copy;
    const core::ConstraintHistory history(tin_);
    for (const Polygon* polygon : wanted)
        copy.polygons.push_back(drape(tin_, history, *polygon));
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
    view_.version = version_;
    view_.vertices = tin_.vertex_count();
    view_.triangles = tin_.triangle_count();
    view_.bounds = tin_.bounds();
    view_.polygons = polygons_.size();
    view_.memory_bytes = tin_.memory_bytes() + polygon_bytes_;
}

PolygonOutcome Session::integrate(PolygonEdit edit) {
    if (edit.dry_run) return integrate_dry(edit);
    const auto lock = lock_to_write();
    if (!is_expected(edit, version_)) return VersionMismatch{version_};
    // Memory first: once the mesh has changed, nothing may fail before it is on record.
    make_room(polygons_, edit.shapes.size());
    const auto kept_report = std::make_shared<core::Report>();
    PolygonResult result;
    result.polygon_ids = polygon_ids(next_polygon_, edit.shapes.size());
    auto report = core::integrate(tin_, edit.shapes, options_for(edit, tin_));
    if (!report) return std::move(report.errors());
    *kept_report = std::move(*report);
    result.report = kept_report;
    result.version = ++version_;
    keep_polygons(edit, result);
    refresh_view();
    if (edit.want_mesh) result.mesh = copy_if_possible(tin_);
    return result;
}

PolygonOutcome Session::integrate_dry(const PolygonEdit& edit) const {
    auto lock = lock_to_read();
    if (!is_expected(edit, version_)) return VersionMismatch{version_};
    core::Tin trial = tin_;
    PolygonResult result;
    result.version = version_;
    result.polygon_ids = polygon_ids(next_polygon_, edit.shapes.size());
    lock.unlock();
    auto report = core::integrate(trial, edit.shapes, options_for(edit, trial));
    if (!report) return std::move(report.errors());
    result.report = std::make_shared<core::Report>(std::move(*report));
    if (edit.want_mesh) result.mesh = trial.to_data();
    return result;
}

void Session::keep_polygons(PolygonEdit& edit, const PolygonResult& result) noexcept {
    for (std::size_t i = 0; i < edit.shapes.size(); ++i) {
        keep_outline(edit.shapes[i]);
        // The ids are short enough to be copied without taking memory.
        polygons_.push_back({result.polygon_ids[i], std::move(edit.origins[i]),
                             std::move(edit.shapes[i]), edit.winding, result.report, i});
        polygon_bytes_ += bytes_of(polygons_.back());
    }
    next_polygon_ += edit.shapes.size();
}

}  // namespace tinsmith::server
