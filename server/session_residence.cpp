// SPDX-License-Identifier: Apache-2.0
// Which sessions of the store are in memory: how they come there from the vault, and leave again.
#include <algorithm>
#include <new>
#include <utility>

#include "server/log.hpp"
#include "server/session_store.hpp"

namespace tinsmith::server {

std::vector<std::string> SessionStore::take_up() {
    std::vector<std::string> damaged;
    if (vault_ == nullptr) return damaged;
    const std::unique_lock lock(mutex_);
    for (VaultEntry& stored : vault_->entries()) {
        if (!stored.damage.empty())
            damaged.push_back("session \"" + stored.facts.id + "\" (" + stored.facts.birth +
                              ") is out of service: " + stored.damage);
        if (stored.facts.id.empty()) continue;  // not even its name can be read
        auto entry = std::make_shared<Entry>();
        entry->facts = std::move(stored.facts);
        entry->owner = std::move(stored.owner);
        entry->counts = stored.counts;
        entry->damage = std::move(stored.damage);
        entry->used = stored.used;
        const std::string id = entry->facts.id;
        entries_.emplace(id, std::move(entry));
    }
    return damaged;
}

std::shared_ptr<Session> SessionStore::load(Entry& entry) {
    const std::lock_guard one(entry.loading);
    {
        const std::shared_lock lock(mutex_);
        if (entry.session && !entry.session->is_lost()) return entry.session;
        if (!entry.damage.empty()) throw SessionIsDamaged(entry.damage);
    }
    // Its bytes, and what is made of them.
    const auto room = borrow(2 * entry.counts.memory_bytes);
    if (!room) throw std::bad_alloc();
    LoadedSession loaded;
    try {
        loaded = vault_->load(entry.facts.birth);
    } catch (const SessionIsDamaged& damaged) {
        const std::unique_lock lock(mutex_);
        entry.damage = damaged.what();
        throw;
    } catch (const SessionIsGone&) {
        return nullptr;
    }
    if (when_loaded) when_loaded(loaded);
    {
        const std::unique_lock lock(mutex_);
        const auto found = entries_.find(entry.facts.id);
        if (found == entries_.end() || found->second.get() != &entry) return nullptr;
        entry.session = loaded.session;
    }
    vault_->tell_if_due(*loaded.session);
    return loaded.session;
}

/// Requires: the lock, exclusive. What leaves memory is freed by the caller, after the lock.
bool SessionStore::make_room(std::size_t bytes, Freed& freed) {
    std::size_t sum = sum_of_memory();
    const std::size_t most = limits_.max_memory_bytes;
    if (bytes > most) return false;
    if (sum <= most - bytes) return true;
    if (vault_ == nullptr) return false;
    std::vector<Entry*> idle;
    std::size_t idle_bytes = 0;
    for (const auto& [id, entry] : entries_) {
        if (!entry->session || entry->session.use_count() != 1) continue;
        idle.push_back(entry.get());
        idle_bytes += entry->session->counts().memory_bytes;
    }
    if (sum - std::min(sum, idle_bytes) > most - bytes) return false;  // nobody leaves in vain
    freed.reserve(freed.size() + idle.size());
    std::ranges::sort(idle, {}, [](const Entry* entry) { return entry->used.load(); });
    for (Entry* entry : idle) {
        if (sum <= most - bytes) break;
        entry->counts = entry->session->counts();
        sum -= std::min(sum, entry->counts.memory_bytes);
        vault_->journal().touch(entry->facts.birth, entry->used);
        freed.push_back(std::move(entry->session));
    }
    return sum <= most - bytes;
}

std::optional<api::SessionView> SessionStore::remove_damaged(const std::string& id,
                                                             const Asker& asker) {
    EntryPtr going;
    api::SessionView last;
    {
        const std::unique_lock lock(mutex_);
        const auto found = entries_.find(id);
        if (found == entries_.end() || found->second->damage.empty()) return std::nullopt;
        if (!asker.may_see(found->second->owner)) return std::nullopt;
        last = view_of_entry(*found->second);
        going = hold_back(found);
    }
    forget_held_back(id, going);
    return last;
}

std::vector<std::string> SessionStore::remove_unused_since(std::int64_t unix_seconds) {
    const auto is_unused = [&](const Entry& entry) {
        return !entry.is_being_made && entry.damage.empty() && last_use(entry) < unix_seconds &&
               (!entry.session || entry.session.use_count() == 1);
    };
    std::vector<std::string> unused;
    {
        const std::shared_lock lock(mutex_);
        for (const auto& [id, entry] : entries_)
            if (is_unused(*entry)) unused.push_back(id);
    }
    std::vector<std::string> births;
    births.reserve(unused.size());
    for (const std::string& id : unused) {
        EntryPtr going;
        {
            const std::unique_lock lock(mutex_);
            const auto found = entries_.find(id);
            if (found == entries_.end() || !is_unused(*found->second)) continue;
            going = hold_back(found);
        }
        try {
            forget_held_back(id, going);
            births.push_back(std::move(going->facts.birth));
        } catch (const std::exception& error) {
            log_event(LogLevel::Warning, "not_expired",
                      "session \"" + id + "\" cannot be ended now: " + error.what());
        }
    }
    return births;
}

void SessionStore::load_all(const std::function<bool()>& go_on) {
    if (vault_ == nullptr) return;
    std::vector<std::pair<std::int64_t, std::string>> waiting;
    std::size_t sum = 0;
    {
        const std::shared_lock lock(mutex_);
        for (const auto& [id, entry] : entries_)
            if (!entry->session && entry->damage.empty()) waiting.emplace_back(-entry->used, id);
    }
    std::ranges::sort(waiting);
    for (const auto& [used, id] : waiting) {
        {
            // Loading must not push out what was loaded before.
            const std::shared_lock lock(mutex_);
            const auto found = entries_.find(id);
            if (found == entries_.end()) continue;
            sum = sum_of_memory() + 2 * found->second->counts.memory_bytes;
        }
        if (!go_on()) return;
        if (sum > limits_.max_memory_bytes) continue;
        const std::int64_t before = -used;
        try {
            find(id, {});
        } catch (const SessionIsDamaged& damaged) {
            log_event(LogLevel::Error, "session_damaged",
                      "session \"" + id + "\" is out of service: " + damaged.what());
        } catch (const std::exception& error) {
            log_event(LogLevel::Warning, "not_loaded",
                      "session \"" + id + "\" is loaded when it is asked for: " + error.what());
        }
        const std::shared_lock lock(mutex_);
        if (const auto found = entries_.find(id); found != entries_.end())
            found->second->used = before;
    }
}

void SessionStore::snapshot(const std::string& id) {
    std::shared_ptr<Session> session;
    {
        const std::shared_lock lock(mutex_);
        const auto found = entries_.find(id);
        if (vault_ == nullptr || found == entries_.end()) return;
        session = found->second->session;
    }
    if (!session || session->is_lost()) return;
    const auto memory = borrow(2 * session->counts().memory_bytes);
    if (!memory) throw std::bad_alloc();
    vault_->snapshot(*session);
}

std::vector<std::string> SessionStore::ids_with_tail() const {
    std::vector<std::string> ids;
    if (vault_ == nullptr) return ids;
    for (const VaultEntry& entry : vault_->entries())
        if (entry.tail > 0 && entry.damage.empty()) ids.push_back(entry.facts.id);
    std::ranges::stable_partition(ids, [this](const std::string& id) {
        const std::shared_lock lock(mutex_);
        const auto found = entries_.find(id);
        return found != entries_.end() && found->second->session;
    });
    return ids;
}

}  // namespace tinsmith::server
