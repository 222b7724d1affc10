// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>

#include "server/store/reading.hpp"
#include "server/store/rows.hpp"

namespace tinsmith::server::store {

/// What is known of a session without a look at the disk.
struct Known {
    std::int64_t number = 0;
    std::string id;
    std::uint64_t newest = 0;  ///< durable
    std::uint64_t snapshot_version = 0;
    std::int64_t snapshot = 0;  ///< its number
    std::string damage;         ///< not empty: takes no more entries
};

/// The sessions that are durable, by birth, and the ids that are taken. Thread-safe; changed by the
/// writer after each commit, so that it never says more than the disk has.
class Catalog {
  public:
    explicit Catalog(const Inventory& inventory);

    std::optional<Known> find(const std::string& birth) const;
    /// Of a session that takes entries; else why not.
    std::optional<JournalFault> why_not(const std::string& birth) const;

    /// Keeps the id and the birth for a session that is being made. Ends with `add` or `release`.
    std::optional<JournalFault> reserve(const StoredFacts& session);
    void release(const StoredFacts& session);
    std::int64_t new_session();
    std::int64_t new_snapshot();

    void add(const StoredFacts& session, const Known& known);
    void remove(const std::string& birth);
    void set_number(const std::string& birth, std::int64_t number);
    void set_newest(const std::string& birth, std::uint64_t version);
    void set_snapshot(const std::string& birth, std::int64_t snapshot, std::uint64_t version);
    void set_damage(const std::string& birth, const std::string& damage);

  private:
    mutable std::mutex mutex_;
    std::unordered_map<std::string, Known> sessions_;  ///< by birth
    std::set<std::string> ids_;                        ///< of sessions and of those being made
    std::set<std::string> births_being_made_;
    std::int64_t next_session_;
    std::int64_t next_snapshot_;
};

/// "no session of that birth": it was removed, or never made.
JournalFault gone(const std::string& birth);

}  // namespace tinsmith::server::store
