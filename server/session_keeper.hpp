// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "server/services.hpp"

namespace tinsmith::server {

/// Looks after the sessions beside the requests, on a thread of its own: stores those that are due
/// for a snapshot, ends those that nobody has asked for within Limits::session_ttl, and has answers
/// dropped that are too old. What fails is logged and tried again, more and more rarely; nothing is
/// tried while the disk takes nothing. Requires: the services outlive it; made before the first
/// request.
class SessionKeeper {
  public:
    explicit SessionKeeper(Services& services);
    /// Waits for a snapshot that is under way.
    ~SessionKeeper();
    SessionKeeper(const SessionKeeper&) = delete;
    SessionKeeper& operator=(const SessionKeeper&) = delete;

    /// Stores all sessions that have changed, in memory or not, as many as there is time for.
    void snapshot_all(std::chrono::steady_clock::time_point until);

  private:
    using Clock = std::chrono::steady_clock;

    /// A session that is due for a snapshot.
    struct Due {
        Clock::time_point from;        ///< not before
        std::chrono::seconds wait{1};  ///< before the next attempt, should this one fail
    };
    enum class IfCold { Load, Leave };
    using Dues = std::map<std::string, Due>;  ///< by id

    void run();
    void tend();
    Dues take_ready();
    void snapshot_or_again(const std::string& id, Due due);
    /// False: it is worth another attempt.
    bool snapshot(const std::string& id, IfCold if_cold);
    void end_unused();
    void forget_answers();

    Services& services_;
    Clock::time_point answers_forgotten_ = Clock::now();
    std::mutex mutex_;  ///< guards the next four
    std::condition_variable woken_;
    Dues due_;
    bool is_one_more_due_ = false;
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace tinsmith::server
