// SPDX-License-Identifier: Apache-2.0
#include "server/session_store.hpp"

#include <mutex>
#include <utility>

#include "server/random_id.hpp"

namespace tinsmith::server {

SessionStore::Added SessionStore::add(core::Tin tin, const api::Terrain& about,
                                      std::optional<std::string> id) {
    SessionFacts facts{id ? std::move(*id) : random_uuid(),
                       random_hex(8),
                       about.name,
                       about.crs,
                       about.unit,
                       about.repairs,
                       about.notes};
    const HistoryLimits history{limits_.max_history, limits_.max_history_bytes};
    return keep(std::make_shared<Session>(std::move(facts), std::move(tin), history));
}

SessionStore::Added SessionStore::fork(const Session& session) {
    return keep(session.fork(random_uuid(), random_hex(8)));
}

SessionStore::Added SessionStore::keep(std::shared_ptr<Session> session) {
    const std::string& key = session->facts().id;
    const std::unique_lock lock(mutex_);
    if (sessions_.contains(key)) return StoreRefusal::IdIsTaken;
    if (sessions_.size() >= limits_.max_sessions) return StoreRefusal::TooMany;
    if (sum_of_memory() + session->view().memory_bytes > limits_.max_memory_bytes) {
        return StoreRefusal::NoMemory;
    }
    sessions_.emplace(key, session);
    return session;
}

std::shared_ptr<Session> SessionStore::find(const std::string& id) const {
    const std::shared_lock lock(mutex_);
    const auto found = sessions_.find(id);
    return found == sessions_.end() ? nullptr : found->second;
}

std::vector<std::shared_ptr<Session>> SessionStore::all() const {
    const std::shared_lock lock(mutex_);
    std::vector<std::shared_ptr<Session>> list;
    list.reserve(sessions_.size());
    for (const auto& [id, session] : sessions_)
        list.push_back(session);
    return list;
}

Removal SessionStore::remove(const Session& session, std::optional<std::uint64_t> expected) {
    std::shared_ptr<Session> last;  // freed after the lock: a mesh is large
    const std::unique_lock lock(mutex_);
    const auto found = sessions_.find(session.facts().id);
    if (found == sessions_.end() || found->second.get() != &session) return Removal::Gone;
    if (expected && *expected != session.view().version) return Removal::OtherVersion;
    last = std::move(found->second);
    sessions_.erase(found);
    return Removal::Done;
}

bool SessionStore::is_kept(const Session& session) const {
    return find(session.facts().id).get() == &session;
}

std::size_t SessionStore::size() const {
    const std::shared_lock lock(mutex_);
    return sessions_.size();
}

std::size_t SessionStore::memory_bytes() const {
    const std::shared_lock lock(mutex_);
    return sum_of_memory();
}

SessionTotals SessionStore::totals() const {
    SessionTotals totals{0, 0, borrowed_};
    for (const auto& session : all()) {
        const api::SessionView view = session->view();
        ++totals.sessions;
        totals.triangles += view.triangles;
        totals.memory_bytes += view.memory_bytes;
    }
    return totals;
}

std::optional<BorrowedMemory> SessionStore::borrow(std::size_t bytes) {
    const std::unique_lock lock(mutex_);
    if (sum_of_memory() + bytes > limits_.max_memory_bytes) return std::nullopt;
    borrowed_ += bytes;
    return std::optional<BorrowedMemory>(std::in_place, borrowed_, bytes);
}

/// Requires: the lock.
std::size_t SessionStore::sum_of_memory() const {
    std::size_t sum = borrowed_;
    for (const auto& [id, session] : sessions_)
        sum += session->view().memory_bytes;
    return sum;
}

}  // namespace tinsmith::server
