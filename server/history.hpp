// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "server/delta.hpp"
#include "server/operation.hpp"

namespace tinsmith::server {

/// How much of its past a session keeps.
struct HistoryLimits {
    std::size_t operations = 1000;
    std::size_t bytes = std::size_t{256} << 20;
};

enum class ChangeKind { Created, Polygons, Locks, Edit, Undo, Redo, Removal };

/// An operation to be run, and the version under which it is known.
struct Rerun {
    std::uint64_t version = 0;
    OperationPtr operation;
};

/// What a change did to the operations on the mesh: those from place `first` on gave way to others.
struct Exchange {
    std::size_t first = 0;  ///< counted from the session's creation
    std::vector<Rerun> removed;
    std::vector<Rerun> added;
};

/// How a version came about. Every version has one.
struct Change {
    std::uint64_t version = 0;
    ChangeKind kind = ChangeKind::Created;
    std::uint64_t of = 0;                           ///< undo, redo: the version they are about
    std::vector<std::string> polygons;              ///< that it brought, took out, or is about
    std::shared_ptr<const core::Report> report;     ///< of a polygons request
    std::shared_ptr<const api::EditAnswer> answer;  ///< of an edit
    std::shared_ptr<const LocksDone> locks;         ///< of a locks request
    std::size_t vertices = 0;                       ///< of the mesh at that version
    std::size_t triangles = 0;
    std::vector<std::shared_ptr<const SlotChanges>> written;  ///< since the version before
    std::optional<Exchange> step;  ///< since the version before; nothing: no longer kept
    std::size_t told_bytes = 0;    ///< about what report, answer, locks and `written` hold
    std::size_t lone_bytes = 0;    ///< about what operations hold that steps alone keep
};

/// What makes the mesh of an earlier version of the mesh as it is.
struct WayBack {
    std::vector<AppliedPtr> taken;  ///< the newest on the mesh, oldest first: to be taken back
    std::vector<Rerun> wanted;      ///< then to be run
};

/// The version is older than what is kept.
struct VersionGone {
    std::uint64_t oldest = 0;
};

/// An edit as undo and redo see it: from place `first` on, operations that the mesh held gave way
/// to others. A polygons request adds one and takes none. Operations alone are kept, to be run
/// again: the same on the same mesh gives the same bytes.
struct Edit {
    std::uint64_t version = 0;
    std::size_t first = 0;  ///< counted from the session's creation
    std::vector<Rerun> removed;
    std::vector<Rerun> added;
    std::vector<std::string> polygons;
    std::size_t removed_bytes = 0;  ///< about what these operations hold in memory
    std::size_t added_bytes = 0;
};

/// What a session keeps of its past: the operations that its mesh holds, the edits that undo and
/// redo go through, and how each version came about.
///
/// Laws: versions only grow, also by undo and redo; a new edit drops what could be redone; beyond
/// the limits the oldest goes first, and an operation that goes becomes part of the base: its
/// polygons stay, but are not taken out any more. The newest edit can always be undone. What the
/// changes tell of themselves takes at most a share of the bytes, the newest one's aside.
/// After `prepare`, the next change to the history cannot fail.
class History {
  public:
    History(HistoryLimits limits, std::size_t vertices, std::size_t triangles);

    std::uint64_t version() const { return changes_.back().version; }
    /// How the versions that are kept came about, oldest first; each follows on the one before.
    const std::vector<Change>& changes() const { return changes_; }
    const Change* change_at(std::uint64_t version) const;
    /// Requires: the version is not a later one than the current. Cost: the changes since, with the
    /// operations on the mesh.
    std::variant<WayBack, VersionGone> way_to(std::uint64_t version) const;
    /// Those that can be taken back, oldest first.
    const std::vector<AppliedPtr>& applied() const { return applied_; }
    /// The place of the first of these, counted from the session's creation.
    std::size_t base() const { return settled_.size(); }
    /// What undo and redo come to next; null: nothing.
    const Edit* undoable() const { return undoable_.empty() ? nullptr : &undoable_.back(); }
    const Edit* redoable() const { return redoable_.empty() ? nullptr : &redoable_.back(); }

    /// All polygons that lie in the mesh, in the order in which they came.
    std::vector<Polygon> polygons() const;
    std::size_t polygon_count() const { return settled_polygons_ + sums_.polygons; }
    /// About what is held beside the mesh.
    std::size_t memory_bytes() const;

    /// From the next change on: its own limits, or these where they are tighter.
    void bound(HistoryLimits limits) noexcept;

    /// Makes room, so that one change with so many new operations takes no memory.
    void prepare(std::size_t added);
    /// A new edit was made: these were run for it, in place of all from its place on.
    void make(Edit edit, std::vector<AppliedPtr> done, Change change) noexcept;
    /// The newest edit was taken back; these were run for it.
    void undo(std::vector<AppliedPtr> done, Change change) noexcept;
    /// The edit taken back last was made again; these were run for it.
    void redo(std::vector<AppliedPtr> done, Change change) noexcept;

    /// Makes all operations part of the base: nothing can be undone, redone or taken out any more,
    /// and no version before this one be made again.
    void settle();

    /// An operation that has become part of the base.
    struct Settled {
        OperationPtr operation;  ///< null: of a kind that nobody asks for any more
        std::shared_ptr<const core::Report> report;
    };

    /// Calls `visit` once with all that it holds but its limits, for those who store it.
    template <typename Either, typename Visit>
    static void each(Either& history, Visit visit) {
        visit(history.changes_, history.settled_, history.told_bytes_, history.settled_bytes_,
              history.settled_polygons_, history.applied_, history.undoable_, history.redoable_);
        if constexpr (!std::is_const_v<Either>) history.sums_ = history.counted();
    }

  private:
    /// Of the lists below, kept as they change: each edit asks for them.
    struct Sums {
        std::size_t polygons = 0;  ///< of `applied_`
        std::size_t applied_bytes = 0;
        std::size_t undoable_bytes = 0;
        std::size_t redoable_bytes = 0;
        std::size_t lone_bytes = 0;  ///< of `changes_`

        friend bool operator==(const Sums&, const Sums&) = default;
    };
    Sums counted() const;
    void add_applied(AppliedPtr applied) noexcept;
    void count_out(const Applied& applied) noexcept;
    void replace(std::size_t first, std::vector<AppliedPtr>& by) noexcept;
    void keep(Change change) noexcept;
    void settle_oldest() noexcept;
    void drop_oldest_undoable() noexcept;
    void leave_to_steps(std::uint64_t version, std::size_t bytes) noexcept;
    bool forget_oldest_lone() noexcept;
    void forget_unreachable() noexcept;
    void forget_step(Change& change) noexcept;
    void drop_oldest_change() noexcept;
    void shrink() noexcept;

    HistoryLimits limits_;
    HistoryLimits in_force_;  ///< the same, or tighter
    std::vector<Change> changes_;
    std::vector<Settled> settled_;  ///< the base, beside what the session was made of
    std::size_t told_bytes_ = 0;    ///< of all changes
    std::size_t settled_bytes_ = 0;
    std::size_t settled_polygons_ = 0;
    std::vector<AppliedPtr> applied_;
    std::vector<Edit> undoable_;
    std::vector<Edit> redoable_;  ///< the next one last
    Sums sums_;
};

}  // namespace tinsmith::server
