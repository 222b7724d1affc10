// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <shared_mutex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/terrain.hpp"
#include "server/limits.hpp"
#include "server/session.hpp"

namespace tinsmith::server {

/// Why a session could not be kept.
enum class StoreRefusal {
    TooMany,    ///< Limits::max_sessions are there already
    NoMemory,   ///< Limits::max_memory_bytes would be passed
    IdIsTaken,  ///< the id of choice exists
};

/// Of all sessions together, at about the same time.
struct SessionTotals {
    std::size_t sessions = 0;
    std::size_t triangles = 0;
    std::size_t memory_bytes = 0;  ///< with what is borrowed
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

/// All sessions of this process, by id. A session that is removed lives on for those who still
/// hold it. Lookups take a shared lock for the time of a map search.
class SessionStore {
  public:
    explicit SessionStore(Limits limits) : limits_(limits) {}

    using Added = std::variant<std::shared_ptr<Session>, StoreRefusal>;

    /// Keeps a mesh as a new session. No id: a random one of 128 bits.
    Added add(core::Tin tin, const api::Terrain& about, std::optional<std::string> id = {});

    /// Keeps a copy of a session as a new one with a random id.
    Added fork(const Session& session);

    /// Null where there is none.
    std::shared_ptr<Session> find(const std::string& id) const;

    /// All sessions in the order of their ids.
    std::vector<std::shared_ptr<Session>> all() const;

    /// Ends this session, unless it has been removed or, where one is expected, has another version
    /// than that. An edit that finishes later finds itself `is_kept` no more: of an edit and a
    /// removal at the same time each sees the other or comes after it.
    Removal remove(const Session& session, std::optional<std::uint64_t> expected = {});

    /// Whether this very session, and not another under its id, is still here.
    bool is_kept(const Session& session) const;

    std::size_t size() const;

    /// Of all sessions together and of what is borrowed. Waits for no edit.
    std::size_t memory_bytes() const;

    /// Waits for no edit.
    SessionTotals totals() const;

    /// Memory for copies; nothing where Limits::max_memory_bytes would be passed. The store
    /// outlives it.
    std::optional<BorrowedMemory> borrow(std::size_t bytes);

  private:
    Added keep(std::shared_ptr<Session> session);
    std::size_t sum_of_memory() const;

    const Limits limits_;
    std::atomic<std::size_t> borrowed_{0};
    mutable std::shared_mutex mutex_;  ///< guards the map, not the sessions
    std::map<std::string, std::shared_ptr<Session>> sessions_;
};

}  // namespace tinsmith::server
