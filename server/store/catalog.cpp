// SPDX-License-Identifier: Apache-2.0
#include "server/store/catalog.hpp"

#include <utility>

#include "server/log.hpp"

namespace tinsmith::server::store {

JournalFault gone(const std::string& birth) {
    return {JournalFault::Kind::Gone,
            "there is no session of birth " + sanitized(birth) + " in the store"};
}

Catalog::Catalog(const Inventory& inventory)
    : next_session_(inventory.next_session), next_snapshot_(inventory.next_snapshot) {
    for (const Listed& listed : inventory.sessions) {
        const SessionRow& row = listed.row;
        if (row.session.birth.empty()) continue;  // damaged: nothing can be said to it by name
        ids_.insert(row.session.id);
        // Of a damaged one the newest is not known: whoever reads it is to meet the damage.
        const std::uint64_t newest = row.damage.empty() ? row.version : kLastVersion;
        sessions_.try_emplace(row.session.birth,
                              Known{listed.number, row.session.id, newest, row.snapshot_version,
                                    listed.snapshot, row.damage});
    }
}

std::optional<Known> Catalog::find(const std::string& birth) const {
    const std::lock_guard lock(mutex_);
    const auto found = sessions_.find(birth);
    return found == sessions_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<JournalFault> Catalog::why_not(const std::string& birth) const {
    const std::lock_guard lock(mutex_);
    const auto found = sessions_.find(birth);
    if (found == sessions_.end()) return gone(birth);
    const std::string& damage = found->second.damage;
    if (damage.empty()) return std::nullopt;
    return JournalFault{JournalFault::Kind::Damaged, damage};
}

std::optional<JournalFault> Catalog::reserve(const StoredFacts& session) {
    const auto conflict = [](const std::string& what) {
        return JournalFault{JournalFault::Kind::Conflict, what};
    };
    const std::lock_guard lock(mutex_);
    if (session.birth.empty()) return conflict("a session needs a birth");
    if (sessions_.contains(session.birth) || births_being_made_.contains(session.birth))
        return conflict("the birth " + sanitized(session.birth) + " is taken");
    if (!ids_.insert(session.id).second)
        return conflict("the id " + sanitized(session.id) + " is taken");
    births_being_made_.insert(session.birth);
    return std::nullopt;
}

void Catalog::release(const StoredFacts& session) {
    const std::lock_guard lock(mutex_);
    ids_.erase(session.id);
    births_being_made_.erase(session.birth);
}

std::int64_t Catalog::new_session() {
    const std::lock_guard lock(mutex_);
    return next_session_++;
}

std::int64_t Catalog::new_snapshot() {
    const std::lock_guard lock(mutex_);
    return next_snapshot_++;
}

void Catalog::add(const StoredFacts& session, const Known& known) {
    const std::lock_guard lock(mutex_);
    births_being_made_.erase(session.birth);
    sessions_.try_emplace(session.birth, known);
}

void Catalog::remove(const std::string& birth) {
    const std::lock_guard lock(mutex_);
    const auto found = sessions_.find(birth);
    if (found == sessions_.end()) return;
    ids_.erase(found->second.id);
    sessions_.erase(found);
}

void Catalog::set_number(const std::string& birth, std::int64_t number) {
    const std::lock_guard lock(mutex_);
    const auto found = sessions_.find(birth);
    if (found != sessions_.end()) found->second.number = number;
}

void Catalog::set_newest(const std::string& birth, std::uint64_t version) {
    const std::lock_guard lock(mutex_);
    const auto found = sessions_.find(birth);
    if (found != sessions_.end()) found->second.newest = version;
}

void Catalog::set_snapshot(const std::string& birth, std::int64_t snapshot, std::uint64_t version) {
    const std::lock_guard lock(mutex_);
    const auto found = sessions_.find(birth);
    if (found == sessions_.end()) return;
    found->second.snapshot = snapshot;
    found->second.snapshot_version = version;
}

void Catalog::set_damage(const std::string& birth, const std::string& damage) {
    const std::lock_guard lock(mutex_);
    const auto found = sessions_.find(birth);
    if (found != sessions_.end()) found->second.damage = damage;
}

}  // namespace tinsmith::server::store
