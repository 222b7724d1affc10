// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "server/change_log.hpp"
#include "server/request_key.hpp"
#include "server/session.hpp"
#include "server/store/journal.hpp"

namespace tinsmith::server {

/// What is stored of a session cannot be read: it is out of service, the others are not.
class SessionIsDamaged : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A session as the vault knows it without loading it.
struct VaultEntry {
    SessionFacts facts;
    std::string owner;  ///< id of the key that made it; empty: none did
    SessionCounts counts;
    std::int64_t used = 0;   ///< Unix seconds
    std::uint64_t tail = 0;  ///< changes since the snapshot
    RequestKey made_by;      ///< of the request that made it
    std::string damage;      ///< not empty: out of service, and why; then the rest may be too
};

/// A change that came with an Idempotency-Key and is not in a snapshot yet.
struct KeyedChange {
    std::uint64_t version = 0;
    std::string key;
    std::string print;
};

struct LoadedSession {
    std::shared_ptr<Session> session;
    std::vector<KeyedChange> keyed;
    std::size_t repeated = 0;  ///< changes since the snapshot
    std::string read_only;     ///< not empty: it takes no changes, and why
};

/// When a session is due for a snapshot: loading it would take longer than this.
struct TailBounds {
    std::size_t entries = 5000;
    std::size_t bytes = std::size_t{64} << 20;
    double seconds = 2.0;  ///< that its changes took
};

/// Sessions in a journal: what the session knows of meshes and what the journal knows of disks.
///
/// Laws: a session that was created here and each of its changes are durable before anybody is told
/// of them; loading gives the session as it was, bit for bit, proven by digests. Where the changes
/// since the snapshot were made by another algorithm of the core, they cannot be made again: the
/// session is as its snapshot has it, and takes no changes. History that another algorithm made is
/// settled. Requires: the vault outlives its sessions.
class SessionVault {
  public:
    static std::variant<std::unique_ptr<SessionVault>, std::string> open(
        const JournalOptions& options, HistoryLimits history, TailBounds tail = {});

    /// The damaged ones among them. Throws StorageFault.
    std::vector<VaultEntry> entries() const;

    /// Stores a new session and has it log its changes here from then on, with the key of the
    /// request that this thread works on. `owner`: the id of the API key that makes it, or empty.
    /// Requires: nobody else has the session yet. Throws StorageFault. Memory: as much as the
    /// session has.
    void create(Session& session, const std::string& owner = {});
    /// Throws SessionIsDamaged, SessionIsGone, StorageFault. Cost: the snapshot, and what its
    /// changes since took.
    LoadedSession load(const std::string& birth);
    /// Calls `when_due` where a session that was loaded came with so long a tail. Requires: it can
    /// be found by its id.
    void tell_if_due(const Session& session);
    /// Throws StorageFault.
    void remove(const std::string& birth);
    /// Stores the session as it is, so that loading it repeats nothing. Nothing to do where no
    /// change came since the last one. Throws StorageFault. Memory: twice the session's.
    void snapshot(const Session& session);

    /// Called on the thread of a change with the session's id, when it is due for a snapshot; once
    /// for each. Set before the first session.
    std::function<void(const std::string& id)> when_due;

    /// The answer that is stored for the key of a change, before a snapshot takes the place of the
    /// entry that has that key: the first answer where it has `most` bytes at most, else what is
    /// told of the change. Nothing: the key is forgotten with the process. Set before the first
    /// session.
    std::function<std::optional<std::string>(const Session& session, const KeyedChange& change,
                                             std::size_t most)>
        answer_of;

    Journal& journal() { return *journal_; }
    const Journal& journal() const { return *journal_; }

  private:
    class Log;
    SessionVault(std::unique_ptr<Journal> journal, HistoryLimits history, TailBounds tail);
    std::shared_ptr<Log> log_of(const SessionFacts& facts);
    std::vector<KeptAnswerRow> answers_to(const Session& session,
                                          std::span<const KeyedChange> changes) const;

    std::unique_ptr<Journal> journal_;
    const HistoryLimits history_;
    const TailBounds tail_;
};

}  // namespace tinsmith::server
