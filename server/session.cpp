// SPDX-License-Identifier: Apache-2.0
#include "server/session.hpp"

#include <algorithm>
#include <mutex>
#include <new>
#include <utility>

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

bool is_expected(const PolygonEdit& edit, std::uint64_t version) {
    return !edit.expected_version || *edit.expected_version == version;
}

}  // namespace

Session::Session(SessionFacts facts, core::Tin tin)
    : facts_(std::move(facts)), tin_(std::move(tin)), memory_bytes_(tin_.memory_bytes()) {}

std::string Session::etag(std::uint64_t version) const {
    return '"' + facts_.birth + '-' + std::to_string(version) + '"';
}

api::SessionView Session::view() const {
    const std::shared_lock lock(mutex_);
    return {facts_.id,
            facts_.name,
            facts_.crs,
            facts_.unit,
            version_,
            tin_.vertex_count(),
            tin_.triangle_count(),
            tin_.bounds(),
            polygons_.size(),
            tin_.memory_bytes()};
}

MeshCopy Session::copy_mesh() const {
    const std::shared_lock lock(mutex_);
    return {tin_.to_data(), version_};
}

PolygonOutcome Session::integrate(PolygonEdit edit) {
    if (edit.dry_run) return integrate_dry(edit);
    const std::unique_lock lock(mutex_);
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
    memory_bytes_.store(tin_.memory_bytes(), std::memory_order_relaxed);
    if (edit.want_mesh) result.mesh = copy_if_possible(tin_);
    return result;
}

PolygonOutcome Session::integrate_dry(const PolygonEdit& edit) const {
    std::shared_lock lock(mutex_);
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
        // The ids are short enough to be copied without taking memory.
        polygons_.push_back({result.polygon_ids[i], std::move(edit.client_ids[i]),
                             std::move(edit.properties[i]), result.report, i});
    }
    next_polygon_ += edit.shapes.size();
}

}  // namespace tinsmith::server
