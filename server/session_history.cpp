// SPDX-License-Identifier: Apache-2.0
// A session's way back and forth: undo, redo, polygons taken out, and what is told of the past.
#include <algorithm>
#include <new>
#include <span>
#include <utility>

#include "server/session.hpp"

namespace tinsmith::server {

namespace {

std::string_view word_of(ChangeKind kind) {
    switch (kind) {
        case ChangeKind::Created:
            return "created";
        case ChangeKind::Polygons:
            return "polygons";
        case ChangeKind::Locks:
            return "locks";
        case ChangeKind::Edit:
            return "edit";
        case ChangeKind::Undo:
            return "undo";
        case ChangeKind::Redo:
            return "redo";
        case ChangeKind::Removal:
            return "polygon_removed";
    }
    return "created";
}

api::ChangeView view_of(const Change& change) {
    return {change.version,  std::string(word_of(change.kind)),
            change.of,       change.polygons,
            change.vertices, change.triangles};
}

std::size_t bytes_of(const std::vector<AppliedPtr>& list) {
    std::size_t sum = 0;
    for (const AppliedPtr& applied : list)
        sum += applied->lasting_bytes;
    return sum;
}

/// The place of the operation that brought the polygon, or the number of all.
std::size_t place_of(const std::vector<AppliedPtr>& list, std::string_view id) {
    const auto found = std::find_if(list.begin(), list.end(), [id](const AppliedPtr& applied) {
        const auto& ids = polygon_ids(*applied->operation);
        return std::find(ids.begin(), ids.end(), id) != ids.end();
    });
    return static_cast<std::size_t>(found - list.begin());
}

}  // namespace

struct Session::Replacement {
    ChangeKind kind = ChangeKind::Undo;
    std::uint64_t of = 0;
    std::vector<std::string> polygons;
    std::size_t first = 0;      ///< the place of the oldest operation to be taken back
    std::vector<Rerun> wanted;  ///< what is to be run in their place
};

ChangeOutcome Session::undo(const ChangeRequest& request) {
    const auto lock = lock_to_write();
    if (!is_expected(request, version())) return VersionMismatch{version()};
    const Edit* edit = history_.undoable();
    if (edit == nullptr) return NothingToDo{};
    return replace(request, UndoAsked{},
                   {ChangeKind::Undo, edit->version, edit->polygons, edit->first, edit->removed});
}

ChangeOutcome Session::redo(const ChangeRequest& request) {
    const auto lock = lock_to_write();
    if (!is_expected(request, version())) return VersionMismatch{version()};
    const Edit* edit = history_.redoable();
    if (edit == nullptr) return NothingToDo{};
    return replace(request, RedoAsked{},
                   {ChangeKind::Redo, edit->version, edit->polygons, edit->first, edit->added});
}

ChangeOutcome Session::remove_polygon(std::string_view id, bool cascade,
                                      const ChangeRequest& request) {
    const auto lock = lock_to_write();
    if (!is_expected(request, version())) return VersionMismatch{version()};
    const std::vector<AppliedPtr>& applied = history_.applied();
    const std::size_t place = place_of(applied, id);
    if (place == applied.size()) {
        const auto all = history_.polygons();
        const bool is_settled = std::any_of(
            all.begin(), all.end(), [id](const Polygon& polygon) { return polygon.id() == id; });
        if (is_settled) return PolygonSettled{};
        return NoSuchPolygon{};
    }
    Replacement removal{ChangeKind::Removal, 0, {std::string(id)}, history_.base() + place, {}};
    PolygonInUse users;
    for (const AppliedPtr& old : std::span(applied).subspan(place)) {
        if (names_polygon(*old->operation, id)) {
            users.versions.push_back(old->version);
            continue;  // it goes too, if it may
        }
        if (OperationPtr rest = without_polygon(old->operation, id).rest) {
            removal.wanted.push_back({old->version, std::move(rest)});
        }
    }
    if (!cascade && !users.versions.empty()) return users;
    return replace(request, RemovalAsked{std::string(id), cascade}, std::move(removal));
}

/// Without an exception. False: the mesh is not what it was before.
bool Session::brought_back(std::span<const AppliedPtr> taken,
                           std::span<const AppliedPtr> done) noexcept {
    try {
        std::vector<Rerun> wanted;
        for (const AppliedPtr& old : taken)
            wanted.push_back({old->version, old->operation});
        // The same operations on the same mesh: what takes the old ones back fits the new ones.
        const auto again = replace_newest(tin_, done, wanted, {}, polygon_finder());
        return std::holds_alternative<std::vector<AppliedPtr>>(again);
    } catch (const std::exception&) {
        return false;
    }
}

/// Requires: the writer's lock.
ChangeOutcome Session::replace(const ChangeRequest& request, const ChangeAsked& asked,
                               Replacement replacement) {
    require_whole();
    const std::uint64_t before = version();
    // Memory first: once the mesh has changed, nothing may fail before it is on record.
    history_.prepare(replacement.wanted.size());
    history_.bound({most_operations_, most_history_bytes_});
    const auto taken = std::span(history_.applied()).subspan(replacement.first - history_.base());
    Exchange step{replacement.first, {}, replacement.wanted};
    for (const AppliedPtr& old : taken)
        step.removed.push_back({old->version, old->operation});
    Edit edit;  // for a new one only: undo and redo have theirs
    if (replacement.kind == ChangeKind::Removal) {
        edit = {before + 1, step.first, step.removed, step.added, replacement.polygons, 0, 0};
        for (const AppliedPtr& old : taken)
            edit.removed_bytes += old->lasting_bytes;
    }
    Change change;
    change.version = before + 1;
    change.kind = replacement.kind;
    change.of = replacement.of;
    change.polygons = replacement.polygons;
    change.step = std::move(step);
    change.written.reserve(taken.size() + replacement.wanted.size());
    for (const AppliedPtr& old : taken)
        change.written.push_back(old->written);
    ChangeResult result{{view_of(change), nullptr, nullptr, nullptr}, std::nullopt};
    const Stopwatch watch;
    auto replayed =
        replace_newest(tin_, taken, replacement.wanted, request.limits, polygon_finder());
    if (auto* failure = std::get_if<ReplayFailure>(&replayed)) return std::move(*failure);

    auto& done = std::get<std::vector<AppliedPtr>>(replayed);
    for (const AppliedPtr& applied : done)
        change.written.push_back(applied->written);
    try {
        digest_ = log_change(asked, taken, done, watch);
    } catch (...) {
        is_lost_ = !brought_back(taken, done);
        throw;
    }
    change.vertices = result.change.view.vertices = tin_.vertex_count();
    change.triangles = result.change.view.triangles = tin_.triangle_count();
    if (replacement.kind == ChangeKind::Undo) {
        history_.undo(std::move(done), std::move(change));
    } else if (replacement.kind == ChangeKind::Redo) {
        history_.redo(std::move(done), std::move(change));
    } else {
        edit.added_bytes = bytes_of(done);
        history_.make(std::move(edit), std::move(done), std::move(change));
    }
    refresh_view();
    if (request.want_delta) result.delta = delta_if_possible(before);
    return result;
}

HistoryCopy Session::history(std::uint64_t after, std::size_t limit) const {
    const auto lock = lock_to_read();
    HistoryCopy copy;
    copy.version = version();
    copy.oldest = history_.changes().front().version;
    if (const Edit* edit = history_.undoable()) copy.undo = edit->version;
    if (const Edit* edit = history_.redoable()) copy.redo = edit->version;
    for (const Change& change : history_.changes()) {
        if (change.version <= after) continue;
        copy.more = copy.changes.size() == limit;
        if (copy.more) break;
        copy.changes.push_back(view_of(change));
    }
    return copy;
}

std::variant<ChangeCopy, VersionGone, VersionAhead> Session::change_at(std::uint64_t wanted) const {
    const auto lock = lock_to_read();
    if (wanted > version()) return VersionAhead{version()};
    const Change* change = history_.change_at(wanted);
    if (change == nullptr) return VersionGone{history_.changes().front().version};
    return ChangeCopy{view_of(*change), change->report, change->locks, change->answer};
}

std::variant<api::MeshDelta, VersionGone, VersionAhead> Session::delta_since(
    std::uint64_t wanted) const {
    const auto lock = lock_to_read();
    if (wanted > version()) return VersionAhead{version()};
    if (wanted == 0) return make_whole(tin_, {}, version());
    const Change* start = history_.change_at(wanted);
    if (start == nullptr) return VersionGone{history_.changes().front().version};
    return delta_from(*start);
}

/// Requires: a lock.
api::MeshDelta Session::delta_from(const Change& start) const {
    std::vector<std::shared_ptr<const SlotChanges>> written;
    for (std::uint64_t v = start.version + 1; v <= version(); ++v) {
        const auto& more = history_.change_at(v)->written;
        written.insert(written.end(), more.begin(), more.end());
    }
    return make_delta(tin_, {start.version, start.vertices, start.triangles}, version(), written);
}

/// The change is made by now: want of memory must not look as if it had failed.
std::optional<api::MeshDelta> Session::delta_if_possible(std::uint64_t from) const {
    try {
        return delta_from(*history_.change_at(from));
    } catch (const std::bad_alloc&) {
        return std::nullopt;
    }
}

}  // namespace tinsmith::server
