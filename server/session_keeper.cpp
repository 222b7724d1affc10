// SPDX-License-Identifier: Apache-2.0
#include "server/session_keeper.hpp"

#include <algorithm>
#include <iterator>
#include <new>
#include <utility>

#include "server/log.hpp"
#include "server/unix_time.hpp"

namespace tinsmith::server {

namespace {

constexpr std::chrono::seconds kBetweenRounds{1};
constexpr std::chrono::seconds kMostWait{600};
constexpr std::chrono::hours kBetweenSweeps{1};

}  // namespace

SessionKeeper::SessionKeeper(Services& services) : services_(services) {
    if (services_.vault) {
        services_.vault->when_due = [this](const std::string& id) {
            const std::lock_guard lock(mutex_);
            due_.try_emplace(id);
            is_one_more_due_ = true;
            woken_.notify_one();
        };
    }
    thread_ = std::thread([this] { run(); });
}

SessionKeeper::~SessionKeeper() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    woken_.notify_one();
    thread_.join();
    if (services_.vault) services_.vault->when_due = nullptr;
}

void SessionKeeper::run() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        woken_.wait_for(lock, kBetweenRounds, [this] { return stopping_ || is_one_more_due_; });
        if (stopping_) return;
        is_one_more_due_ = false;
        lock.unlock();
        tend();
        lock.lock();
    }
}

/// The thread must outlive whatever happens to one session.
void SessionKeeper::tend() {
    try {
        if (services_.vault && services_.vault->journal().health().fine)
            for (const auto& [id, due] : take_ready())
                snapshot_or_again(id, due);
        end_unused();
        forget_answers();
    } catch (const std::exception& error) {
        log_event(LogLevel::Warning, "keeping_failed",
                  std::string("sessions are looked after again later: ") + error.what());
    }
}

SessionKeeper::Dues SessionKeeper::take_ready() {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    Dues ready;
    for (auto due = due_.begin(); due != due_.end();) {
        const auto next = std::next(due);
        if (due->second.from <= now) ready.insert(due_.extract(due));
        due = next;
    }
    return ready;
}

void SessionKeeper::snapshot_or_again(const std::string& id, Due due) {
    {
        const std::lock_guard lock(mutex_);
        if (stopping_) return;
    }
    if (snapshot(id, IfCold::Leave)) return;
    const std::lock_guard lock(mutex_);
    due.from = Clock::now() + due.wait;
    due.wait = std::min(2 * due.wait, kMostWait);
    due_.insert_or_assign(id, due);
}

bool SessionKeeper::snapshot(const std::string& id, IfCold if_cold) {
    try {
        std::shared_ptr<Session> held;
        if (if_cold == IfCold::Load) held = services_.sessions.find(id, {});
        services_.sessions.snapshot(id);
        return true;
    } catch (const SessionIsGone&) {
        return true;  // removed in the meantime
    } catch (const SessionIsDamaged& damaged) {
        log_event(LogLevel::Error, "session_damaged",
                  "session \"" + id + "\" cannot be stored anew: " + damaged.what());
        return true;
    } catch (const std::bad_alloc&) {
        log_event(LogLevel::Warning, "snapshot_failed",
                  "no memory to store session \"" + id + "\" now");
    } catch (const std::exception& error) {
        log_event(LogLevel::Warning, "snapshot_failed",
                  "session \"" + id + "\" cannot be stored now: " + error.what());
    }
    return false;
}

void SessionKeeper::end_unused() {
    const std::uint64_t ttl = services_.limits.session_ttl;
    if (ttl == 0) return;
    const auto oldest = unix_seconds() - static_cast<std::int64_t>(ttl);
    for (const std::string& birth : services_.sessions.remove_unused_since(oldest)) {
        services_.meshes.forget(birth);
        services_.answers.forget(birth);
        log_event(LogLevel::Info, "expired", "a session that nobody asked for has ended",
                  {{"birth", birth}});
    }
}

void SessionKeeper::forget_answers() {
    if (!services_.vault || Clock::now() - answers_forgotten_ < kBetweenSweeps) return;
    answers_forgotten_ = Clock::now();
    services_.vault->journal().forget_answers(unix_seconds() - KeptAnswers::Bounds{}.age.count());
}

void SessionKeeper::snapshot_all(Clock::time_point until) {
    try {
        for (const std::string& id : services_.sessions.ids_with_tail()) {
            if (Clock::now() >= until) {
                log_event(LogLevel::Warning, "snapshot_failed",
                          "no time is left to store every session: the next start repeats changes");
                return;
            }
            snapshot(id, IfCold::Load);
        }
    } catch (const std::exception& error) {
        log_event(LogLevel::Warning, "snapshot_failed",
                  std::string("no session is stored anew: ") + error.what());
    }
}

}  // namespace tinsmith::server
