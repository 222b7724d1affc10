// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/formats/geojson_writer.hpp"
#include "api/responses.hpp"
#include "core/integrate/integrator.hpp"
#include "core/mesh/repair.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/mesh_data.hpp"
#include "server/change.hpp"
#include "server/change_log.hpp"
#include "server/edit.hpp"
#include "server/history.hpp"
#include "server/locks.hpp"
#include "server/polygon.hpp"
#include "server/stopwatch.hpp"

namespace tinsmith::server {

/// What never changes about a session.
struct SessionFacts {
    std::string id;
    std::string birth;  ///< random, new each time an id is created: two lives never share an ETag
    std::string name;
    std::string crs;  ///< empty: unknown
    std::string unit;
    std::optional<std::vector<core::Repair>> repairs = std::nullopt;  ///< nothing: not asked for
    std::vector<std::string> notes = {};  ///< on what its reader passed over
};

/// A mesh at one version, copied out so that it can be encoded while the session goes on.
struct MeshCopy {
    core::MeshData mesh;
    std::uint64_t version = 0;
};

/// Polygons at one version, copied out in the same way.
struct DrapedCopy {
    std::vector<api::DrapedPolygon> polygons;
    std::uint64_t version = 0;
    bool more = false;  ///< others follow these
};

/// A session's mesh at a version, and the polygons that lay in it then.
struct SessionState {
    core::Tin tin;
    std::vector<Polygon> polygons;
    std::vector<AppliedPtr> held;  ///< what the polygons are views of; the session must live, too
};

/// All that a session is, where it is.
struct SessionParts {
    const SessionFacts& facts;
    const core::Tin& tin;
    const History& history;
    const std::uint64_t& next_polygon;
    const std::string& digest;
};

/// The same copied out, so that it can be stored while the session goes on.
struct SessionImage {
    SessionFacts facts;
    core::Tin tin;
    History history;
    std::uint64_t next_polygon = 1;
    std::string digest;  ///< running; see ChangeLog

    SessionParts parts() const { return {facts, tin, history, next_polygon, digest}; }
};

using VersionOutcome = std::variant<core::Tin, VersionGone, VersionAhead, core::Errors>;
using StateOutcome = std::variant<SessionState, VersionGone, VersionAhead, core::Errors>;

/// What listings tell of a session.
api::SessionView view_of(const SessionFacts& facts, const SessionCounts& counts);

/// One terrain in memory: its mesh, its version and its polygons.
///
/// Laws: one writer at a time, readers beside each other; an edit that fails leaves mesh, version,
/// polygons and history as they were; a version is never used twice; nothing is encoded under a
/// lock.
class Session {
  public:
    Session(SessionFacts facts, core::Tin tin, HistoryLimits limits = {});
    /// As the one was that the image is of.
    explicit Session(SessionImage image);

    /// A session of its own with all that this one has now: mesh, version, history and the ids to
    /// come. Takes the readers' lock for the time of a copy.
    std::shared_ptr<Session> fork(std::string id, std::string birth) const;
    /// Takes the readers' lock for the time of a copy.
    SessionImage image() const;
    /// Without a copy. Requires: nobody else has the session yet.
    SessionParts parts() const { return {facts_, tin_, history_, next_polygon_, digest_}; }

    /// From now on no change is told of before the log has kept it; nobody sees it earlier, for the
    /// writer's lock is held meanwhile. What the log refuses is taken back. Requires: nobody else
    /// has the session yet.
    void start_log(std::shared_ptr<ChangeLog> log);
    std::shared_ptr<ChangeLog> log() const { return log_; }
    /// One more of the notes that views carry. Requires: nobody else has the session yet.
    void add_note(std::string note) { view_.notes.push_back(std::move(note)); }
    /// Makes a change again that was logged. Returns nothing where its version and digest came out
    /// as they were then, else what is wrong. Requires: nobody else has the session yet, no log.
    std::optional<std::string> repeat(const ChangeAsked& asked, std::uint64_t version,
                                      std::string_view digest);
    /// A change that the log refused could not be taken back, for want of memory: the mesh is not
    /// what the log says, and nobody should use the session any more.
    bool is_lost() const { return is_lost_; }
    SessionCounts counts() const;

    /// What it keeps of its past from its next change on: as its own limits say, or these where
    /// they are tighter. Takes no lock.
    void bound_history(HistoryLimits limits) {
        most_operations_ = limits.operations;
        most_history_bytes_ = limits.bytes;
    }

    const SessionFacts& facts() const { return facts_; }
    std::string etag(std::uint64_t version) const;

    /// As of the last finished edit: does not wait for one under way.
    api::SessionView view() const;
    MeshCopy copy_mesh() const;
    /// The mesh with all that the core knows of it.
    core::Tin copy_tin() const;
    /// The same as it was at a version, made on a copy: operations are taken back and, where they
    /// were undone or removed since, run again. Requires nothing of the session but its lock for
    /// the time of a copy. Errors: cancelled.
    VersionOutcome tin_at(std::uint64_t wanted, const RunLimits& limits) const;
    /// The same with the polygons of that version.
    StateOutcome state_at(std::uint64_t wanted, const RunLimits& limits) const;
    /// Whether `tin_at` has it; nothing: it does.
    std::variant<std::monostate, VersionGone, VersionAhead> missing(std::uint64_t wanted) const;
    /// Bytes of a copy of the mesh. Waits for no edit.
    std::size_t mesh_bytes() const;
    /// About what making the mesh of an earlier version takes: the largest that it was since. Takes
    /// the readers' lock.
    std::size_t mesh_bytes_since(std::uint64_t wanted) const;
    /// All polygons, or the one of that id, as they lie in the mesh now; no polygon where none has
    /// it. Holds the readers' lock while their regions are found.
    DrapedCopy draped(std::optional<std::string_view> id = {}) const;
    /// What `look` makes of the mesh, its polygons and its version, which are as they are now while
    /// it runs: under the readers' lock, so it should be short, and let go of all three.
    template <typename Look>
    auto look(Look look) const {
        const auto lock = lock_to_read();
        return look(tin_, history_.polygons(), version());
    }
    /// The same for at most `limit` polygons, those that came after p`number`.
    DrapedCopy draped_after(std::uint64_t number, std::size_t limit) const;
    /// Integrates all shapes or none. A dry run works on a copy and holds no writer's lock.
    /// Requires: shapes and origins of one length.
    PolygonOutcome integrate(PolygonEdit edit);

    /// Locks or unlocks the edges along lines: all of them or none. Dry runs as above.
    LocksOutcome set_locks(LocksEdit edit, RunLimits limits);
    /// At most `limit` locked edges, in order, those after one with this number of a side; nothing:
    /// from the first on. Cost: the whole mesh.
    LockedCopy locked_after(std::optional<std::uint32_t> side, std::size_t limit) const;
    /// Edits the mesh inside a polygon. A dry run works on a copy and holds no writer's lock.
    EditOutcome edit(PendingEdit edit);

    /// Takes the newest edit back that was not taken back.
    ChangeOutcome undo(const ChangeRequest& request);
    /// Does the edit again that was taken back last: the same bytes as before.
    ChangeOutcome redo(const ChangeRequest& request);
    /// Takes a polygon out. The mesh is then, byte for byte, that of a session which was given the
    /// operations without it; edits that name it are refused, or go too. An edit itself, for undo.
    ChangeOutcome remove_polygon(std::string_view id, bool cascade, const ChangeRequest& request);

    /// At most `limit` changes, those that came after a version.
    HistoryCopy history(std::uint64_t after = 0, std::size_t limit = SIZE_MAX) const;
    /// How that version came about.
    std::variant<ChangeCopy, VersionGone, VersionAhead> change_at(std::uint64_t wanted) const;
    /// What leads from that version to the mesh as it is now. 0: the whole mesh.
    std::variant<api::MeshDelta, VersionGone, VersionAhead> delta_since(std::uint64_t wanted) const;

  private:
    PolygonOutcome integrate_dry(const PolygonEdit& edit) const;
    LocksOutcome lock_dry(const LocksEdit& edit, const RunLimits& limits) const;
    EditOutcome edit_dry(const PendingEdit& edit) const;
    /// Runs one operation more and keeps it as the next version. An error leaves everything as it
    /// was. Requires: the writer's lock.
    core::Result<AppliedPtr> perform(OperationPtr operation, ChangeKind kind,
                                     std::vector<std::string> polygons, const RunLimits& limits);
    /// Of the operations that the mesh holds now. Requires: a lock, for as long as it is in use.
    PolygonFinder polygon_finder() const;
    /// Has the log keep what the mesh has just become. Requires: the writer's lock, and that
    /// `taken` were taken back and `done` were run. Returns the running digest.
    std::string log_change(const ChangeAsked& asked, std::span<const AppliedPtr> taken,
                           std::span<const AppliedPtr> done, const Stopwatch& watch) const;
    /// Requires: a lock.
    SessionSize size_now() const;
    SessionCounts counts_now(std::uint64_t version) const;
    void require_whole() const {
        if (is_lost_) throw StorageFault("The session has to be loaded again.");
    }
    bool taken_back(const core::Undo& undo) noexcept;
    /// What `replace` does to the newest operations, and how that is kept.
    struct Replacement;
    ChangeOutcome replace(const ChangeRequest& request, const ChangeAsked& asked,
                          Replacement replacement);
    bool brought_back(std::span<const AppliedPtr> taken, std::span<const AppliedPtr> done) noexcept;
    std::optional<core::MeshData> mesh_if_possible() const;
    std::optional<core::AngleCounts> angles_if_possible(const core::Undo& undo) const;
    std::optional<api::MeshDelta> delta_if_possible(std::uint64_t from) const;
    api::MeshDelta delta_from(const Change& start) const;
    std::uint64_t version() const { return history_.version(); }
    void refresh_view() noexcept;

    std::shared_lock<std::shared_mutex> lock_to_read() const;
    std::unique_lock<std::shared_mutex> lock_to_write() const;

    const SessionFacts facts_;
    mutable std::mutex turn_;  ///< held while waiting for the next, so that readers queue too
    mutable std::shared_mutex mutex_;  ///< guards mesh, history and the next polygon's number
    core::Tin tin_;
    History history_;
    std::uint64_t next_polygon_ = 1;
    std::shared_ptr<ChangeLog> log_;  ///< null: nothing is kept
    std::string digest_;              ///< running; empty: nobody wants it
    std::atomic<bool> is_lost_{false};
    std::atomic<std::size_t> most_operations_{SIZE_MAX};
    std::atomic<std::size_t> most_history_bytes_{SIZE_MAX};

    mutable std::mutex view_mutex_;  ///< guards the view; taken last and never held for long
    api::SessionView view_;
    std::size_t mesh_bytes_ = 0;
};

}  // namespace tinsmith::server
