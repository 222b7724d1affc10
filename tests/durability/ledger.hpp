// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "tests/durability/random_shapes.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {

/// A request that a client makes until it is acknowledged.
struct Intent {
    enum class Kind { Change, Question, Create, Fork, RemoveSession };
    Kind kind = Kind::Change;
    std::string session{};  ///< its id; of a fork the source's
    std::string method{};
    std::string path{};  ///< below the session's; of Create all of it
    std::vector<std::string> headers{};
    std::string body{};
    std::string history_kind{};  ///< of a Change: what the history is to call it
    std::string key{};           ///< empty: it has none, and then it has this version by If-Match:
    std::uint64_t if_match = 0;
    std::string content_type = "application/json";
    int slot = 0;      ///< of Create, Fork and RemoveSession
    int attempts = 0;  ///< so far
};

/// What is known of a session because it was acknowledged.
struct SessionRecord {
    std::string id;
    Intent origin;                            ///< Create or Fork
    std::uint64_t first_version = 1;          ///< that it had when it was made
    std::map<std::uint64_t, Intent> changes;  ///< by the version each made
    std::string last_polygons;                ///< body of a polygons request
    int polygons = 0;                         ///< at least so many ids were given
};

/// Everything that was acknowledged to anybody. For many threads.
class Ledger {
  public:
    /// What is wrong with an acknowledgement; empty: nothing.
    std::string add_change(const Intent& intent, std::uint64_t version) {
        const std::lock_guard lock(mutex_);
        ++acknowledged_;
        const auto found = sessions_.find(intent.session);
        if (found == sessions_.end()) return {};  // removed by another in the meantime
        SessionRecord& record = found->second;
        if (intent.history_kind == "polygons") {
            ++record.polygons;
            record.last_polygons = intent.body;
        }
        const auto [other, is_new] = record.changes.try_emplace(version, intent);
        if (is_new) return {};
        return "version " + std::to_string(version) + " of " + intent.session +
               " was acknowledged twice: " + other->second.path + " " + other->second.key +
               " and " + intent.path + " " + intent.key;
    }

    std::string add_session(SessionRecord record) {
        const std::lock_guard lock(mutex_);
        ++acknowledged_;
        slots_[record.origin.slot] = record.id;
        const std::string id = record.id;
        if (sessions_.try_emplace(id, std::move(record)).second) return {};
        return "session " + id + " was made twice";
    }

    void remove_session(const std::string& id, int slot) {
        const std::lock_guard lock(mutex_);
        ++acknowledged_;
        sessions_.erase(id);
        if (slots_[slot] == id) slots_.erase(slot);
    }

    /// The id of the session in a slot; empty: there is none now.
    std::string in_slot(int slot) const {
        const std::lock_guard lock(mutex_);
        const auto found = slots_.find(slot);
        return found == slots_.end() ? "" : found->second;
    }

    /// The body of a polygons request that was acknowledged of a session (empty: none), and how
    /// many there were.
    std::pair<std::string, int> polygons_of(const std::string& id) const {
        const std::lock_guard lock(mutex_);
        const auto found = sessions_.find(id);
        if (found == sessions_.end()) return {};
        return {found->second.last_polygons, found->second.polygons};
    }

    SessionRecord record(const std::string& id) const {
        const std::lock_guard lock(mutex_);
        const auto found = sessions_.find(id);
        return found == sessions_.end() ? SessionRecord() : found->second;
    }

    std::map<std::string, SessionRecord> sessions() const {
        const std::lock_guard lock(mutex_);
        return sessions_;
    }

    void add_replay() {
        const std::lock_guard lock(mutex_);
        ++replayed_;
    }
    void add_fault(std::string fault) {
        const std::lock_guard lock(mutex_);
        faults_.push_back(std::move(fault));
    }
    std::vector<std::string> take_faults() {
        const std::lock_guard lock(mutex_);
        return std::exchange(faults_, {});
    }
    std::size_t acknowledged() const {
        const std::lock_guard lock(mutex_);
        return acknowledged_;
    }
    std::size_t replayed() const {
        const std::lock_guard lock(mutex_);
        return replayed_;
    }

  private:
    mutable std::mutex mutex_;
    std::map<std::string, SessionRecord> sessions_;
    std::map<int, std::string> slots_;
    std::vector<std::string> faults_;
    std::size_t acknowledged_ = 0;
    std::size_t replayed_ = 0;
};

/// The number in "<birth>-<version>"; 0: there is none.
inline std::uint64_t version_of_tag(const std::string& tag) {
    const std::size_t dash = tag.find('-');
    return dash == std::string::npos ? 0 : std::strtoull(tag.c_str() + dash + 1, nullptr, 10);
}

}  // namespace tinsmith::e2e
