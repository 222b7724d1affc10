// SPDX-License-Identifier: Apache-2.0
#include "server/kept_answers.hpp"

namespace tinsmith::server {

namespace {

/// The part of all bytes that one answer may take.
constexpr std::size_t kShare = 8;

std::size_t bytes_of(const KeptAnswers::Name& name, const Response& answer) {
    // Names stand in three places; the rest is about what the containers take.
    std::size_t bytes = 3 * (name.first.size() + name.second.size()) + 512;
    for (const auto& [key, value] : answer.headers)
        bytes += sizeof(NameValue) + key.size() + value.size();
    return bytes + answer.body.size();
}

}  // namespace

KeptAnswers::Verdict KeptAnswers::begin(const Name& name, const std::string& print) {
    const std::lock_guard lock(mutex_);
    make_room();
    const auto [place, is_new] = entries_.try_emplace(name);
    Entry& entry = place->second;
    if (is_new) {
        entry.print = print;
        return GoOn{};
    }
    if (entry.print != print) return OtherRequest{};
    if (entry.running) return StillRunning{};
    if (!entry.whole) return NoBody{};
    return entry.answer;
}

void KeptAnswers::keep(const Name& name, const Response& answer) {
    const std::lock_guard lock(mutex_);
    const auto place = entries_.find(name);
    if (place == entries_.end()) return;
    Entry& entry = place->second;
    entry.whole = bytes_of(name, answer) <= bounds_.bytes / kShare;
    if (entry.whole) entry.answer = answer;
    entry.bytes = bytes_of(name, entry.answer);
    entry.since = clock_();
    entry.place = order_.insert(order_.end(), name);
    auto& siblings = of_scope_[name.first];
    siblings.push_back(name);
    entry.running = false;
    bytes_ += entry.bytes;
    if (siblings.size() > bounds_.per_scope) erase(entries_.find(siblings.front()));
    make_room();
}

void KeptAnswers::drop(const Name& name) noexcept {
    const std::lock_guard lock(mutex_);
    const auto place = entries_.find(name);
    if (place != entries_.end() && place->second.running) entries_.erase(place);
}

/// Drops what is too old or too much. Requires: the lock.
void KeptAnswers::make_room() {
    const Time now = clock_();
    while (!order_.empty()) {
        const auto oldest = entries_.find(order_.front());
        if (bytes_ <= bounds_.bytes && now - oldest->second.since < bounds_.age) return;
        erase(oldest);
    }
}

/// Requires: the lock, and the oldest of its scope, not running.
void KeptAnswers::erase(Entries::iterator entry) {
    const auto siblings = of_scope_.find(entry->first.first);
    siblings->second.pop_front();
    if (siblings->second.empty()) of_scope_.erase(siblings);
    order_.erase(entry->second.place);
    bytes_ -= entry->second.bytes;
    entries_.erase(entry);
}

void KeptAnswers::forget(const std::string& scope) {
    const std::lock_guard lock(mutex_);
    for (auto of = of_scope_.find(scope); of != of_scope_.end(); of = of_scope_.find(scope))
        erase(entries_.find(of->second.front()));
}

std::size_t KeptAnswers::size() const {
    const std::lock_guard lock(mutex_);
    return order_.size();
}

std::size_t KeptAnswers::bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
}

}  // namespace tinsmith::server
