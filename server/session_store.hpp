// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/terrain.hpp"
#include "server/keys/asker.hpp"
#include "server/limits.hpp"
#include "server/session.hpp"
#include "server/session_vault.hpp"
#include "server/unix_time.hpp"

namespace tinsmith::server {

/// Why a session could not be kept.
enum class StoreRefusal {
    TooMany,        ///< Limits::max_sessions are there already
    TooLarge,       ///< it is more than Limits::max_session_bytes
    NoMemory,       ///< Limits::max_memory_bytes would be passed
    IdIsTaken,      ///< the id of choice exists, whoever sees it
    TooManyOfKey,   ///< KeyQuotas::max_sessions of the asker are there already
    NoMemoryOfKey,  ///< KeyQuotas::max_memory_bytes would be passed
};

/// Of all sessions together, at about the same time.
struct SessionTotals {
    std::size_t sessions = 0;
    std::size_t in_memory = 0;
    std::size_t out_of_service = 0;
    std::size_t triangles = 0;
    std::size_t memory_bytes = 0;  ///< with what is borrowed
};

/// What one key has.
struct KeyShare {
    std::size_t sessions = 0;
    std::size_t memory_bytes = 0;  ///< of those in memory and of those that are not
};

enum class Removal { Done, Gone, OtherVersion };

/// Memory for copies that a request works on, given back with the object.
class BorrowedMemory {
  public:
    BorrowedMemory(std::atomic<std::size_t>& sum, std::size_t bytes) : sum_(&sum), bytes_(bytes) {}
    BorrowedMemory(BorrowedMemory&& other) noexcept
        : sum_(other.sum_), bytes_(std::exchange(other.bytes_, 0)) {}
    BorrowedMemory& operator=(BorrowedMemory&&) = delete;
    ~BorrowedMemory() { *sum_ -= bytes_; }

  private:
    std::atomic<std::size_t>* sum_;
    std::size_t bytes_;
};

/// All sessions of this service, by id: in memory alone, or, with a vault, in memory as long as
/// there is room and on the disk always. A session that is removed lives on for those who still
/// hold it. Lookups take a shared lock for the time of a map search; one of a session that is not
/// in memory loads it, and whoever else asks for that one waits for it, nobody else.
///
/// Laws, with a vault: a session that is told of is stored; one that nobody holds leaves memory
/// where another needs it, the one used longest ago first, and comes back with the next request as
/// it was; one that cannot be loaded is out of service until it is removed.
///
/// A session is its maker's (Asker::may_see): for other keys it is not there, but that its id is
/// taken.
class SessionStore {
  public:
    /// No vault: sessions end with the process. The vault outlives the store.
    explicit SessionStore(Limits limits, SessionVault* vault = nullptr)
        : limits_(limits), vault_(vault) {}

    /// Takes up what the vault has, without loading anything. Before the first request. Returns
    /// what is damaged, a sentence for each. Throws StorageFault.
    std::vector<std::string> take_up();
    /// Called with each session that was loaded, before anybody gets it. Set before the first
    /// request.
    std::function<void(const LoadedSession&)> when_loaded;

    using Added = std::variant<std::shared_ptr<Session>, StoreRefusal>;

    /// Keeps a mesh as a new session of the asker. No id: a random one of 128 bits. Throws
    /// StorageFault.
    Added add(core::Tin tin, const api::Terrain& about, const Asker& asker,
              std::optional<std::string> id = {});

    /// Keeps a copy of a session as a new one of the asker, with a random id. Throws StorageFault.
    Added fork(const Session& session, const Asker& asker);

    /// Null where there is none that the asker may see. Throws SessionIsDamaged, StorageFault, and
    /// std::bad_alloc where there is no room to load it.
    std::shared_ptr<Session> find(const std::string& id, const Asker& asker);
    /// Whether there is one, loaded or not, whoever sees it.
    bool contains(const std::string& id) const;

    /// At most `limit` sessions in the order of their ids, those after one. Loads nothing.
    struct Page {
        std::vector<api::SessionView> views;
        bool more = false;
    };
    Page page(const std::string& after, std::size_t limit, const Asker& asker) const;
    /// The session's, with when it ends if nobody asks for it.
    api::SessionView view(const Session& session) const;

    /// Ends this session, unless it has been removed or, where one is expected, has another version
    /// than that. An edit that finishes later finds itself `is_kept` no more: of an edit and a
    /// removal at the same time each sees the other or comes after it. Throws StorageFault.
    Removal remove(const Session& session, std::optional<std::uint64_t> expected = {});
    /// Ends a session that is out of service; nothing where it is not, or not the asker's to see.
    /// Throws StorageFault.
    std::optional<api::SessionView> remove_damaged(const std::string& id, const Asker& asker);
    /// Ends those that nobody asked for since then. Returns their births. What cannot be ended is
    /// logged, and stays.
    std::vector<std::string> remove_unused_since(std::int64_t unix_seconds);

    /// Whether this very session, and not another under its id, is still here.
    bool is_kept(const Session& session) const;

    std::size_t size() const;
    /// Of the key of that id. Cost: the sessions.
    KeyShare share_of(const std::string& owner) const;

    /// Of all sessions in memory together and of what is borrowed. Waits for no edit.
    std::size_t memory_bytes() const;
    /// Waits for no edit.
    SessionTotals totals() const;

    /// Whether so many bytes more are within Limits::max_memory_bytes, once sessions that nobody
    /// holds have left memory.
    bool has_room(std::size_t bytes);
    /// Memory for copies; nothing where there is no room. The store outlives it.
    std::optional<BorrowedMemory> borrow(std::size_t bytes);

    /// Loads sessions, the ones used last first, while there is room and `go_on` says so. What
    /// cannot be loaded is logged.
    void load_all(const std::function<bool()>& go_on);
    /// Stores a session as it is. Nothing to do for those that are not in memory. Throws
    /// StorageFault, std::bad_alloc.
    void snapshot(const std::string& id);
    /// Those that have changed since they were stored whole, in memory or not; the ones in memory
    /// first. Throws StorageFault. Cost: a row for each session of the vault.
    std::vector<std::string> ids_with_tail() const;

  private:
    struct Entry {
        SessionFacts facts;
        std::string owner;                 ///< id of the key that made it; empty: none did
        SessionCounts counts;              ///< of one that is not in memory
        std::shared_ptr<Session> session;  ///< null: not in memory
        std::string damage;                ///< not empty: out of service
        bool is_being_made = false;        ///< nobody is to find it yet
        std::atomic<std::int64_t> used{0};
        std::mutex loading;  ///< held while it is loaded; taken before the map's
    };
    using EntryPtr = std::shared_ptr<Entry>;
    using Entries = std::map<std::string, EntryPtr>;
    using Freed = std::vector<std::shared_ptr<Session>>;  ///< to be freed outside of the lock

    Added keep(std::shared_ptr<Session> session, const Asker& asker);
    /// Requires: the lock.
    KeyShare share_now(const std::string& owner) const;
    std::optional<StoreRefusal> refusal_of_quota(const Asker& asker, std::size_t bytes) const;
    std::shared_ptr<Session> load(Entry& entry);
    bool make_room(std::size_t bytes, Freed& freed);
    std::size_t sum_of_memory() const;
    api::SessionView view_of_entry(const Entry& entry) const;
    void touch(Entry& entry) const;
    /// When somebody asked for it last, as far as a time to live goes: what came of questions
    /// before this process began is not on the disk, so that the start counts as one.
    std::int64_t last_use(const Entry& entry) const;
    /// Takes an entry out so that its id stays taken and nobody finds it, until `let_go` or
    /// `put_back`. Requires: the lock, exclusive.
    EntryPtr hold_back(Entries::iterator place);
    void let_go(const std::string& id);
    void put_back(const std::string& id, EntryPtr entry);
    /// Has the vault forget what was held back; where it cannot, all is as before. Throws
    /// StorageFault.
    void forget_held_back(const std::string& id, const EntryPtr& entry);

    const Limits limits_;
    SessionVault* const vault_;
    const std::int64_t began_ = unix_seconds();
    std::atomic<std::size_t> borrowed_{0};
    mutable std::shared_mutex mutex_;  ///< guards the map and its entries, not the sessions
    Entries entries_;
};

}  // namespace tinsmith::server
