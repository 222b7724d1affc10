// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/store/rows.hpp"

namespace tinsmith::server {

struct JournalOptions {
    std::filesystem::path folder;  ///< made, for its owner alone, where it is not there
    std::string vfs;               ///< SQLite's name for a file system; empty: the usual one

    /// Bounds of one commit.
    std::size_t group_entries = 1000;
    std::size_t group_bytes = std::size_t{16} << 20;
    /// Bounds of what waits for a commit; `append` waits for room.
    std::size_t queue_entries = 4000;
    std::size_t queue_bytes = std::size_t{64} << 20;
    /// Snapshots go in parts of so many bytes, a commit each.
    std::size_t part_bytes = std::size_t{1} << 20;
    /// A log of so many pages of 4 KiB is moved into the file, in some tens of milliseconds.
    int log_pages = 1000;
    /// Makes the log that long at the start. A sync of a file that grows costs many times one of a
    /// file that is written over.
    bool grow_log = true;
    /// Of kept answers that wait for a commit, and of those that are stored.
    std::size_t waiting_answer_bytes = std::size_t{16} << 20;
    std::size_t stored_answer_bytes = std::size_t{256} << 20;
    /// While the disk fails, how often it is tried.
    std::chrono::milliseconds probe_every{1000};
};

/// Whether what is told can be made durable.
struct JournalHealth {
    bool fine = true;
    std::string why;  ///< where not
    std::chrono::system_clock::time_point since;
};

struct JournalFigures {
    /// Of commits by how long they took, write and sync; the last one: longer than all of these.
    static constexpr std::array<double, 10> kSeconds = {0.0005, 0.001, 0.002, 0.005, 0.01,
                                                        0.02,   0.05,  0.1,   0.5,   2.0};

    std::uint64_t commits = 0;
    std::uint64_t entries = 0;
    std::uint64_t largest_group = 0;  ///< entries in one commit
    std::uint64_t failures = 0;       ///< commits that did not come about
    double commit_seconds = 0.0;      ///< all together
    std::array<std::uint64_t, kSeconds.size() + 1> commits_within{};  ///< each in one of them
    std::uint64_t checkpoints = 0;
    double checkpoint_seconds = 0.0;
    std::size_t queued_entries = 0;     ///< now
    std::size_t queued_bytes = 0;       ///< now
    std::uint64_t written_bytes = 0;    ///< of entries and snapshots
    std::uint64_t file_bytes = 0;       ///< the database, now
    std::uint64_t log_bytes = 0;        ///< its write-ahead log, now
    std::uint64_t swept_rows = 0;       ///< entries and parts that counted no more
    std::uint64_t answers_dropped = 0;  ///< for want of room in the queue
};

/// The store underneath the sessions: what was acknowledged is there after a crash, and after the
/// power was cut. It knows bytes, not meshes.
///
/// Laws: what returns Committed returns when the disk has it, or says why not; then memory has to
/// be as if it had never been asked. Entries of one session are stored in the order of their
/// versions without a hole. A snapshot or a new session is there whole or not at all. What is read
/// is what was written: a damaged row takes its session out of service, by a fault that names it,
/// and no other. After a fault the next call may go through: nothing has to be opened again.
/// Not promised: that a refused change is absent where the process ends while the disk still fails
/// (the log may hold it whole); a client that retries by its key finds out.
/// Threads: all functions may be called from any thread; `append` of one session from one at a
/// time, for its order is that of the calls. Calls end before the destructor begins.
/// Nothing here throws but std::bad_alloc.
class Journal {
  public:
    /// The text says why not, and what to do.
    static std::variant<std::unique_ptr<Journal>, std::string> open(const JournalOptions& options);
    /// As `close`.
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// Cost: the disk's write and sync, shared with whoever else waits for one.
    Committed append(JournalEntry entry);

    /// A new session, as `bytes` make it at `head.version`. Conflict where the id or the birth is
    /// taken, or just being made.
    Committed create(const StoredFacts& session, const SnapshotHead& head, std::string_view bytes);

    /// From then on `read` starts here; entries up to that version count no more. Requires: a
    /// version from that of the last snapshot to the newest. Commits of others go between its
    /// parts. One at a time for a session. `answers` are stored with it, or it is not: the entries
    /// that count no more may be the only ones that tell of their keys.
    Committed write_snapshot(const std::string& birth, const SnapshotHead& head,
                             std::string_view bytes, std::vector<KeptAnswerRow> answers = {});

    Committed remove(const std::string& birth);

    /// Both are not waited for: they go with the next commit, a second later at the latest. One
    /// that is lost with the power does no harm.
    void touch(const std::string& birth, std::int64_t unix_seconds) noexcept;
    void keep_answer(KeptAnswerRow answer) noexcept;

    /// As they are now, the damaged ones among them.
    std::variant<std::vector<SessionRow>, JournalFault> sessions() const;

    /// Waits for no commit. Cost: linear in the bytes. The log grows while it reads: what others
    /// commit meanwhile cannot be moved into the file.
    std::variant<StoredSession, JournalFault> read(const std::string& birth) const;

    /// The oldest first. Of one scope and key the last counts. Damaged ones are left out.
    std::variant<std::vector<KeptAnswerRow>, JournalFault> answers(
        std::int64_t newer_than_unix_seconds) const;
    /// Not waited for.
    void forget_answers(std::int64_t older_than_unix_seconds) noexcept;

    /// Waits for no commit.
    JournalHealth health() const;
    JournalFigures figures() const;

    /// Takes no more on, makes durable what waits, and leaves one file with all in it. From one
    /// thread at a time.
    void close() noexcept;

  private:
    class Implementation;
    explicit Journal(std::unique_ptr<Implementation> implementation);
    std::unique_ptr<Implementation> implementation_;
};

/// Copies a store, also one that another process serves from, into the folder `to`, which is made
/// or is empty: as it is at one moment, every commit before it and none after. Returns why it
/// failed, else nothing; where it failed there is no copy. A server takes the folder as it is.
std::optional<std::string> backup_store(const std::filesystem::path& folder,
                                        const std::filesystem::path& to);

}  // namespace tinsmith::server
