// SPDX-License-Identifier: Apache-2.0
#include "server/session_keeper.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "server/log.hpp"
#include "server/unix_time.hpp"

namespace tinsmith::server {

namespace {

constexpr std::chrono::seconds kBetweenRounds{1};

}  // namespace

SessionKeeper::SessionKeeper(Services& services) : services_(services) {
    if (services_.vault) {
        services_.vault->when_due = [this](const std::string& id) {
            const std::lock_guard lock(mutex_);
            due_.push_back(id);
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
        woken_.wait_for(lock, kBetweenRounds, [this] { return stopping_ || !due_.empty(); });
        std::deque<std::string> now;
        std::swap(now, due_);
        const bool is_last = stopping_;
        lock.unlock();
        std::deque<std::string> again;
        for (std::string& id : now)
            if (!is_last && !snapshot(id)) again.push_back(std::move(id));
        end_unused();
        lock.lock();
        // What failed waits for the next round.
        if (!again.empty() && !stopping_)
            woken_.wait_for(lock, kBetweenRounds, [this] { return stopping_; });
        due_.insert(due_.end(), again.begin(), again.end());
    }
}

bool SessionKeeper::snapshot(const std::string& id) {
    try {
        services_.sessions.snapshot(id);
        return true;
    } catch (const SessionIsGone&) {
        return true;  // removed in the meantime
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

void SessionKeeper::snapshot_all(Clock::time_point until) {
    for (const std::string& id : services_.sessions.ids_in_memory()) {
        if (Clock::now() >= until) {
            log_event(LogLevel::Warning, "snapshot_failed",
                      "no time is left to store every session: the next start repeats changes");
            return;
        }
        snapshot(id);
    }
}

}  // namespace tinsmith::server
