// SPDX-License-Identifier: Apache-2.0
#include "server/session_store.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "server/random_id.hpp"
#include "server/unix_time.hpp"

namespace tinsmith::server {

SessionStore::Added SessionStore::add(core::Tin tin, const api::Terrain& about, const Asker& asker,
                                      std::optional<std::string> id) {
    SessionFacts facts{id ? std::move(*id) : random_uuid(),
                       random_hex(8),
                       about.name,
                       about.crs,
                       about.unit,
                       about.repairs,
                       about.notes};
    const HistoryLimits history{limits_.max_history, limits_.max_history_bytes};
    return keep(std::make_shared<Session>(std::move(facts), std::move(tin), history), asker);
}

SessionStore::Added SessionStore::fork(const Session& session, const Asker& asker) {
    return keep(session.fork(random_uuid(), random_hex(8)), asker);
}

SessionStore::Added SessionStore::keep(std::shared_ptr<Session> session, const Asker& asker) {
    const std::string& id = session->facts().id;
    const auto entry = std::make_shared<Entry>();
    entry->facts = session->facts();
    entry->owner = asker.id;
    entry->counts = session->counts();
    entry->is_being_made = true;
    touch(*entry);
    Freed freed;
    {
        const std::unique_lock lock(mutex_);
        if (entries_.contains(id)) return StoreRefusal::IdIsTaken;
        if (entry->counts.memory_bytes > within_quotas(limits_, asker.quotas).max_session_bytes)
            return StoreRefusal::TooLarge;
        if (const auto quota = refusal_of_quota(asker, entry->counts.memory_bytes)) return *quota;
        if (entries_.size() >= limits_.max_sessions) return StoreRefusal::TooMany;
        if (!make_room(entry->counts.memory_bytes, freed)) return StoreRefusal::NoMemory;
        entries_.emplace(id, entry);
    }
    try {
        if (vault_ != nullptr) {
            const auto bytes = borrow(entry->counts.memory_bytes);  // that are written
            if (!bytes) {
                let_go(id);
                return StoreRefusal::NoMemory;
            }
            vault_->create(*session, asker.id);
        }
    } catch (...) {
        let_go(id);
        throw;
    }
    const std::unique_lock lock(mutex_);
    entry->session = session;
    entry->is_being_made = false;
    return session;
}

std::optional<StoreRefusal> SessionStore::refusal_of_quota(const Asker& asker,
                                                           std::size_t bytes) const {
    const auto& max_sessions = asker.quotas.max_sessions;
    const auto& max_memory = asker.quotas.max_memory_bytes;
    if (!max_sessions && !max_memory) return std::nullopt;
    const KeyShare share = share_now(asker.id);
    if (max_sessions && share.sessions >= *max_sessions) return StoreRefusal::TooManyOfKey;
    const bool has_room = !max_memory || (share.memory_bytes <= *max_memory &&
                                          bytes <= *max_memory - share.memory_bytes);
    return has_room ? std::nullopt : std::optional(StoreRefusal::NoMemoryOfKey);
}

std::shared_ptr<Session> SessionStore::find(const std::string& id, const Asker& asker) {
    EntryPtr entry;
    std::shared_ptr<Session> session;
    {
        const std::shared_lock lock(mutex_);
        const auto found = entries_.find(id);
        if (found == entries_.end() || found->second->is_being_made) return nullptr;
        if (!asker.may_see(found->second->owner)) return nullptr;
        entry = found->second;
        touch(*entry);
        if (entry->session && !entry->session->is_lost()) session = entry->session;
    }
    if (!session) session = load(*entry);
    // What nobody made in particular is not one key's to forget.
    if (session && !asker.id.empty() && asker.id == entry->owner) {
        const Limits limits = within_quotas(limits_, asker.quotas);
        session->bound_history({limits.max_history, limits.max_history_bytes});
    }
    return session;
}

bool SessionStore::contains(const std::string& id) const {
    const std::shared_lock lock(mutex_);
    return entries_.contains(id);
}

SessionStore::Page SessionStore::page(const std::string& after, std::size_t limit,
                                      const Asker& asker) const {
    const std::shared_lock lock(mutex_);
    Page page;
    for (auto entry = entries_.upper_bound(after); entry != entries_.end(); ++entry) {
        if (entry->second->is_being_made || !asker.may_see(entry->second->owner)) continue;
        page.more = page.views.size() == limit;
        if (page.more) break;
        page.views.push_back(view_of_entry(*entry->second));
    }
    return page;
}

api::SessionView SessionStore::view(const Session& session) const {
    const std::shared_lock lock(mutex_);
    const auto found = entries_.find(session.facts().id);
    if (found == entries_.end() || found->second->session.get() != &session) return session.view();
    return view_of_entry(*found->second);
}

/// Requires: the lock.
api::SessionView SessionStore::view_of_entry(const Entry& entry) const {
    api::SessionView view =
        entry.session ? entry.session->view() : view_of(entry.facts, entry.counts);
    // The page knows it by how it begins.
    if (!entry.damage.empty()) view.notes.push_back("Out of service: " + entry.damage);
    if (limits_.session_ttl > 0)
        view.expires = last_use(entry) + static_cast<std::int64_t>(limits_.session_ttl);
    return view;
}

Removal SessionStore::remove(const Session& session, std::optional<std::uint64_t> expected) {
    const std::string& id = session.facts().id;
    EntryPtr going;  // freed after the lock: a mesh is large
    {
        const std::unique_lock lock(mutex_);
        const auto found = entries_.find(id);
        if (found == entries_.end() || found->second->session.get() != &session)
            return Removal::Gone;
        if (expected && *expected != session.view().version) return Removal::OtherVersion;
        going = hold_back(found);
    }
    forget_held_back(id, going);
    return Removal::Done;
}

SessionStore::EntryPtr SessionStore::hold_back(Entries::iterator place) {
    auto nobodys = std::make_shared<Entry>();
    nobodys->is_being_made = true;
    return std::exchange(place->second, std::move(nobodys));
}

void SessionStore::let_go(const std::string& id) {
    const std::unique_lock lock(mutex_);
    entries_.erase(id);
}

void SessionStore::put_back(const std::string& id, EntryPtr entry) {
    const std::unique_lock lock(mutex_);
    entries_.find(id)->second = std::move(entry);
}

void SessionStore::forget_held_back(const std::string& id, const EntryPtr& entry) {
    try {
        if (vault_ != nullptr) vault_->remove(entry->facts.birth);
    } catch (...) {
        put_back(id, entry);
        throw;
    }
    let_go(id);
}

bool SessionStore::is_kept(const Session& session) const {
    const std::shared_lock lock(mutex_);
    const auto found = entries_.find(session.facts().id);
    return found != entries_.end() && found->second->session.get() == &session;
}

std::size_t SessionStore::size() const {
    const std::shared_lock lock(mutex_);
    return entries_.size();
}

KeyShare SessionStore::share_of(const std::string& owner) const {
    const std::shared_lock lock(mutex_);
    return share_now(owner);
}

KeyShare SessionStore::share_now(const std::string& owner) const {
    KeyShare share;
    for (const auto& [id, entry] : entries_) {
        if (entry->owner != owner) continue;
        ++share.sessions;
        share.memory_bytes +=
            (entry->session ? entry->session->counts() : entry->counts).memory_bytes;
    }
    return share;
}

std::size_t SessionStore::memory_bytes() const {
    const std::shared_lock lock(mutex_);
    return sum_of_memory();
}

SessionTotals SessionStore::totals() const {
    const std::shared_lock lock(mutex_);
    SessionTotals totals;
    totals.memory_bytes = sum_of_memory();
    totals.sessions = entries_.size();
    for (const auto& [id, entry] : entries_) {
        if (!entry->damage.empty()) ++totals.out_of_service;
        if (entry->session) ++totals.in_memory;
        totals.triangles +=
            entry->session ? entry->session->counts().triangles : entry->counts.triangles;
    }
    return totals;
}

bool SessionStore::has_room(std::size_t bytes) {
    Freed freed;
    const std::unique_lock lock(mutex_);
    return make_room(bytes, freed);
}

std::optional<BorrowedMemory> SessionStore::borrow(std::size_t bytes) {
    Freed freed;
    const std::unique_lock lock(mutex_);
    if (!make_room(bytes, freed)) return std::nullopt;
    borrowed_ += bytes;
    return std::optional<BorrowedMemory>(std::in_place, borrowed_, bytes);
}

/// Requires: the lock.
std::size_t SessionStore::sum_of_memory() const {
    std::size_t sum = borrowed_;
    for (const auto& [id, entry] : entries_) {
        if (entry->session)
            sum += entry->session->counts().memory_bytes;
        else if (entry->is_being_made)
            sum += entry->counts.memory_bytes;
    }
    return sum;
}

void SessionStore::touch(Entry& entry) const {
    entry.used = unix_seconds();
}

std::int64_t SessionStore::last_use(const Entry& entry) const {
    return std::max<std::int64_t>(entry.used, began_);
}

}  // namespace tinsmith::server
