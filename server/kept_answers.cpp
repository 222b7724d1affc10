// SPDX-License-Identifier: Apache-2.0
#include "server/kept_answers.hpp"

#include <algorithm>
#include <iterator>
#include <new>
#include <utility>

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

/// What was done must not look undone for want of memory.
bool copy_if_possible(const Response& answer, Response& copy) {
    try {
        copy = answer;
        return true;
    } catch (const std::bad_alloc&) {
        copy = {};
        return false;
    }
}

/// Puts the name last in both orders, or throws and leaves them. Its scope.
template <typename Order, typename Scopes>
auto& append(Order& order, Scopes& scopes, const KeptAnswers::Name& name) {
    order.push_back(name);
    try {
        auto& scope = scopes[name.first];
        try {
            scope.names.push_back(name);
        } catch (...) {
            if (scope.names.empty()) scopes.erase(name.first);
            throw;
        }
        return scope;
    } catch (...) {
        order.pop_back();
        throw;
    }
}

}  // namespace

KeptAnswers::Verdict KeptAnswers::begin(const Name& name, const std::string& print) {
    const std::lock_guard lock(mutex_);
    make_room();
    Entry fresh;
    fresh.print = print;
    const auto [place, is_new] = entries_.try_emplace(name, std::move(fresh));
    if (is_new) return GoOn{};
    const Entry& entry = place->second;
    if (entry.print != print) return OtherRequest{};
    if (entry.running) return StillRunning{};
    if (!entry.whole) return NoBody{};
    return entry.answer;
}

std::uint64_t KeptAnswers::keep(const Name& name, const Response& answer) {
    std::uint64_t number = 0;
    std::string print;
    {
        const std::lock_guard lock(mutex_);
        number = count_ + 1;
        const auto place = entries_.find(name);
        if (place == entries_.end()) return ++count_;
        print = place->second.print;
        fill(place, answer, clock_());
    }
    if (when_kept) when_kept(name, print, answer);
    return number;
}

std::optional<Response> KeptAnswers::find(const Name& name) const {
    const std::lock_guard lock(mutex_);
    const auto place = entries_.find(name);
    if (place == entries_.end() || place->second.running || !place->second.whole)
        return std::nullopt;
    return place->second.answer;
}

void KeptAnswers::restore(const Name& name, const std::string& print, const Response& answer,
                          std::chrono::seconds age) {
    const std::lock_guard lock(mutex_);
    Entry fresh;
    fresh.print = print;
    const auto [place, is_new] = entries_.try_emplace(name, std::move(fresh));
    if (is_new) fill(place, answer, clock_() - age);
}

/// Requires: the lock.
void KeptAnswers::fill(Entries::iterator place, const Response& answer, Time since) {
    const Name& name = place->first;
    Entry& entry = place->second;
    entry.whole = bytes_of(name, answer) <= bounds_.bytes / kShare;
    if (entry.whole) entry.whole = copy_if_possible(answer, entry.answer);
    entry.since = since;
    Scope& scope = append(order_, scopes_, name);
    entry.place = std::prev(order_.end());
    entry.running = false;
    entry.number = ++count_;
    count(scope, entry, bytes_of(name, entry.answer));
    if (scope.names.size() > bounds_.per_scope) erase(entries_.find(scope.names.front()));
    make_room();
}

/// The entry takes so many bytes now. Requires: the lock.
void KeptAnswers::count(Scope& scope, Entry& entry, std::size_t bytes) {
    scope.bytes += bytes - entry.bytes;
    bytes_ += bytes - entry.bytes;
    entry.bytes = bytes;
}

void KeptAnswers::take_back(const Name& name, std::uint64_t number) noexcept {
    const std::lock_guard lock(mutex_);
    const auto place = entries_.find(name);
    if (place != entries_.end() && !place->second.running && place->second.number == number)
        erase(place);
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
        if (now - oldest->second.since < bounds_.age) break;
        erase(oldest);
    }
    // Ends: each turn takes a body or a key.
    while (bytes_ > bounds_.bytes && !order_.empty()) {
        if (const auto scope = largest(true); scope != scopes_.end()) {
            take_oldest_body(scope->second);
        } else {
            erase(entries_.find(largest(false)->second.names.front()));
        }
    }
}

/// The scope that takes the most, of all or of those that have bodies; the end: there is none.
KeptAnswers::Scopes::iterator KeptAnswers::largest(bool with_bodies) {
    auto most = scopes_.end();
    for (auto scope = scopes_.begin(); scope != scopes_.end(); ++scope) {
        if (with_bodies && scope->second.bare == scope->second.names.size()) continue;
        if (most == scopes_.end() || scope->second.bytes > most->second.bytes) most = scope;
    }
    return most;
}

/// Requires: not all of them are bare.
void KeptAnswers::take_oldest_body(Scope& scope) {
    Entry& entry = entries_.find(scope.names[scope.bare++])->second;
    entry.whole = false;
    entry.answer = {};
    count(scope, entry, bytes_of(scope.names[scope.bare - 1], entry.answer));
}

/// Requires: the lock, and not running. Fast for the oldest of its scope.
void KeptAnswers::erase(Entries::iterator entry) {
    const auto of = scopes_.find(entry->first.first);
    Scope& scope = of->second;
    const auto name = std::find(scope.names.begin(), scope.names.end(), entry->first);
    if (static_cast<std::size_t>(name - scope.names.begin()) < scope.bare) --scope.bare;
    scope.names.erase(name);
    count(scope, entry->second, 0);
    if (scope.names.empty()) scopes_.erase(of);
    order_.erase(entry->second.place);
    entries_.erase(entry);
}

void KeptAnswers::forget(const std::string& scope) {
    const std::lock_guard lock(mutex_);
    for (auto of = scopes_.find(scope); of != scopes_.end(); of = scopes_.find(scope))
        erase(entries_.find(of->second.names.front()));
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
