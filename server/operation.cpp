// SPDX-License-Identifier: Apache-2.0
#include "server/operation.hpp"

#include <algorithm>
#include <utility>

#include "core/mesh/surgery.hpp"

namespace tinsmith::server {

std::size_t held_bytes(const core::Shape& shape) {
    std::size_t sum = sizeof shape;
    for (const core::Path& path : shape.paths)
        sum += sizeof path + path.points.size() * sizeof(core::Point2) +
               path.elevations.size() * sizeof(double);
    return sum;
}

std::size_t held_bytes(const core::ShapeReport& report) {
    std::size_t sum = sizeof report;
    for (const core::Chain& chain : report.chains)
        sum += sizeof chain + chain.vertices.size() * sizeof(core::VertexId);
    for (const core::OutsidePart& part : report.outside)
        sum += sizeof part + part.points.size() * sizeof(core::Point2);
    return sum;
}

std::size_t held_bytes(const LocksDone& done) {
    std::size_t sum = sizeof done;
    for (const core::LockReport& report : done.paths) {
        sum += sizeof report;
        for (const auto& stretch : report.without_edge)
            sum += sizeof stretch + stretch.size() * sizeof(core::Point2);
    }
    return sum;
}

std::size_t held_bytes(const SlotChanges& written) {
    return sizeof written +
           (written.vertices.size() + written.triangles.size()) * sizeof(std::uint32_t);
}

namespace {

/// About what one shape of a request holds in memory, its part of the report with it.
std::size_t bytes_of(const PolygonsOperation& operation, const core::Report& report,
                     std::size_t shape) {
    const PolygonOrigin& origin = operation.origins[shape];
    std::size_t sum = sizeof origin + origin.properties.size() + origin.client_id.size() +
                      origin.polygon_starts.size() * sizeof(std::size_t);
    return sum + held_bytes(operation.shapes[shape]) + held_bytes(report.shapes[shape]);
}

std::size_t bytes_of(const EditOperation& operation) {
    std::size_t sum = sizeof operation + sizeof(api::EditAnswer) + operation.asked.polygon.size();
    const auto* raised = std::get_if<core::ElevationEdit>(&operation.edit);
    if (raised != nullptr && raised->strip)
        sum += held_bytes(raised->strip->ring) + held_bytes(raised->strip->border);
    return sum;
}

std::size_t bytes_of(const core::Undo& undo, const SlotChanges& written) {
    std::size_t sum = sizeof(Applied);
    for (const core::UndoRecord& record : undo) {
        sum += sizeof record + record.triangles.size() * sizeof record.triangles[0] +
               record.vertices.size() * sizeof record.vertices[0];
        if (record.removal) sum += record.removal->memory_bytes();
    }
    return sum + held_bytes(written);
}

/// Takes an operation back unless told to keep it.
class Guard {
  public:
    Guard(core::Tin& tin, core::Undo& undo) : tin_(tin), undo_(undo) {}
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;
    ~Guard() {
        if (!kept_) core::take_back(tin_, std::move(undo_));
    }
    void keep() { kept_ = true; }

  private:
    core::Tin& tin_;
    core::Undo& undo_;
    bool kept_ = false;
};

core::Result<AppliedPtr> run_kind(core::Tin& tin, const PolygonsOperation& polygons,
                                  std::shared_ptr<Applied> applied, const RunLimits& limits,
                                  const PolygonFinder& /*find*/) {
    core::IntegrateOptions options = polygons.options;
    options.cancelled = limits.cancelled;
    options.clock_ms = limits.clock_ms;
    options.progress = limits.progress;
    options.max_crossings = limits.max_crossings;
    options.max_new_triangles = limits.max_new_triangles;
    const auto kept_report = std::make_shared<core::Report>();
    auto report = core::integrate(tin, polygons.shapes, options, &applied->undo);
    if (!report) return std::move(report.errors());
    Guard guard(tin, applied->undo);
    *kept_report = std::move(*report);
    applied->written = std::make_shared<SlotChanges>(slot_changes(tin, applied->undo));
    for (std::size_t i = 0; i < polygons.shapes.size(); ++i)
        applied->lasting_bytes += bytes_of(polygons, *kept_report, i);
    applied->record_bytes = bytes_of(applied->undo, *applied->written);
    applied->report = kept_report;
    guard.keep();
    return AppliedPtr(std::move(applied));
}

std::size_t bytes_of(const LocksOperation& operation, const LocksDone& done) {
    std::size_t sum = sizeof operation + held_bytes(done);
    for (const core::Shape& shape : operation.shapes)
        sum += held_bytes(shape);
    return sum;
}

bool found_nothing(const core::Errors& errors) {
    return errors.front().code == core::ErrorCode::NoEdgeAlong;
}

/// What ends a request whatever its other paths are.
bool ends_all(core::ErrorCode code) {
    return code == core::ErrorCode::CrossingBudget || code == core::ErrorCode::Cancelled;
}

/// Whole or not at all: a path that is refused takes the others with it, all faults are told.
core::Result<AppliedPtr> run_kind(core::Tin& tin, const LocksOperation& locks,
                                  std::shared_ptr<Applied> applied, const RunLimits& limits,
                                  const PolygonFinder& /*find*/) {
    const auto done = std::make_shared<LocksDone>();
    done->locked = locks.locked;
    Guard guard(tin, applied->undo);
    core::LockBudget budget{limits.max_crossings, limits.cancelled};  // of all paths together
    core::Errors errors;
    for (std::size_t s = 0; s < locks.shapes.size(); ++s) {
        for (std::size_t p = 0; p < locks.shapes[s].paths.size(); ++p) {
            if (limits.cancelled && limits.cancelled()) {
                return core::Error{core::ErrorCode::Cancelled, "the request was cancelled", {}};
            }
            const core::Path& path = locks.shapes[s].paths[p];
            applied->undo.emplace_back(core::Surgery(tin).commit());  // of nothing: room first
            core::Undo undo;
            auto report = core::lock_along(tin, path, locks.reach, locks.locked, &undo, &budget);
            if (report) {
                applied->undo.back() = std::move(undo.front());
                done->paths.push_back(std::move(*report));
            } else if (found_nothing(report.errors()) && !limits.must_find) {
                done->paths.push_back({0, 0, 0.0, {path.points}});
            } else {
                for (core::Error& error : report.errors()) {
                    if (errors.size() >= core::kMaxFaults) break;
                    error.place.shape = s;
                    error.place.path = p;
                    if (ends_all(error.code)) return std::move(error);
                    errors.push_back(std::move(error));
                }
            }
        }
    }
    if (!errors.empty()) return errors;
    applied->written = std::make_shared<SlotChanges>(slot_changes(tin, applied->undo));
    applied->report = std::make_shared<core::Report>();
    applied->lasting_bytes = bytes_of(locks, *done);
    applied->record_bytes = bytes_of(applied->undo, *applied->written);
    applied->locks = done;
    guard.keep();
    return AppliedPtr(std::move(applied));
}

core::Result<AppliedPtr> run_kind(core::Tin& tin, const EditOperation& edit,
                                  std::shared_ptr<Applied> applied, const RunLimits& limits,
                                  const PolygonFinder& find) {
    const std::optional<Polygon> polygon = find(edit.asked.polygon);
    if (!polygon) {
        return core::Error{core::ErrorCode::NothingInside,
                           "the polygon \"" + edit.asked.polygon + "\" is no longer there",
                           {}};
    }
    const core::ShapeReport& own = polygon->own_report();
    const core::EditLimits budgets{limits.max_crossings, limits.max_new_triangles, {},
                                   limits.cancelled,     limits.clock_ms,          limits.progress};
    const auto kept_answer = std::make_shared<api::EditAnswer>(edit.asked);
    auto report = core::edit_region(tin, {polygon->outline(), own.chains, own.outside},
                                    polygon->request.winding, edit.edit, budgets, &applied->undo);
    if (!report) return std::move(report.errors());
    Guard guard(tin, applied->undo);
    report->apply_ms += edit.asked.report.apply_ms;
    kept_answer->report = *report;
    applied->written = std::make_shared<SlotChanges>(slot_changes(tin, applied->undo));
    applied->lasting_bytes = bytes_of(edit);
    applied->record_bytes = bytes_of(applied->undo, *applied->written);
    applied->answer = kept_answer;
    guard.keep();
    return AppliedPtr(std::move(applied));
}

/// Polygons stand on the ground alone, never on one another by name.
bool names(const PolygonsOperation&, std::string_view) {
    return false;
}
bool names(const LocksOperation&, std::string_view) {
    return false;
}

bool names(const EditOperation& edit, std::string_view id) {
    return edit.asked.polygon == id;
}

Remainder without(const PolygonsOperation& polygons, const OperationPtr& whole,
                  std::string_view id) {
    const auto found = std::find(polygons.ids.begin(), polygons.ids.end(), id);
    if (found == polygons.ids.end()) return {false, whole};
    if (polygons.ids.size() == 1) return {true, nullptr};
    PolygonsOperation rest = polygons;
    const auto place = found - polygons.ids.begin();
    rest.ids.erase(rest.ids.begin() + place);
    rest.shapes.erase(rest.shapes.begin() + place);
    rest.origins.erase(rest.origins.begin() + place);
    return {true, std::make_shared<const Operation>(std::move(rest))};
}

Remainder without(const LocksOperation&, const OperationPtr& whole, std::string_view) {
    return {false, whole};
}

Remainder without(const EditOperation&, const OperationPtr& whole, std::string_view) {
    return {false, whole};
}

const std::vector<std::string>& ids_of(const PolygonsOperation& polygons) {
    return polygons.ids;
}
const std::vector<std::string>& ids_of(const LocksOperation&) {
    static const std::vector<std::string> kNone;
    return kNone;
}

const std::vector<std::string>& ids_of(const EditOperation&) {
    static const std::vector<std::string> kNone;
    return kNone;
}

}  // namespace

// Each visits by overload: a kind that lacks one of them does not compile.

core::Result<AppliedPtr> run(core::Tin& tin, std::uint64_t version, OperationPtr operation,
                             const RunLimits& limits, const PolygonFinder& find) {
    auto applied = std::make_shared<Applied>();
    applied->version = version;
    applied->operation = std::move(operation);
    const Operation& any = *applied->operation;
    return std::visit(
        [&](const auto& kind) { return run_kind(tin, kind, std::move(applied), limits, find); },
        any);
}

std::optional<Polygon> polygon_of(const Applied& applied, std::string_view id) {
    const auto* request = std::get_if<PolygonsOperation>(&*applied.operation);
    if (request == nullptr) return std::nullopt;
    const auto found = std::find(request->ids.begin(), request->ids.end(), id);
    if (found == request->ids.end()) return std::nullopt;
    return Polygon{*request, *applied.report,
                   static_cast<std::size_t>(found - request->ids.begin())};
}

bool names_polygon(const Operation& operation, std::string_view id) {
    return std::visit([id](const auto& kind) { return names(kind, id); }, operation);
}

Remainder without_polygon(const OperationPtr& operation, std::string_view id) {
    return std::visit([&](const auto& kind) { return without(kind, operation, id); }, *operation);
}

const std::vector<std::string>& polygon_ids(const Operation& operation) {
    return std::visit(
        [](const auto& kind) -> const std::vector<std::string>& { return ids_of(kind); },
        operation);
}

}  // namespace tinsmith::server
