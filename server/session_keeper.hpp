// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "server/services.hpp"

namespace tinsmith::server {

/// Looks after the sessions beside the requests, on a thread of its own: stores those that are due
/// for a snapshot, and ends those that nobody has asked for within Limits::session_ttl.
/// What fails is logged and tried again. Requires: the services outlive it; made before the first
/// request.
class SessionKeeper {
  public:
    explicit SessionKeeper(Services& services);
    /// Waits for a snapshot that is under way.
    ~SessionKeeper();
    SessionKeeper(const SessionKeeper&) = delete;
    SessionKeeper& operator=(const SessionKeeper&) = delete;

    /// Stores all sessions in memory that have changed, as many as there is time for. Requires: no
    /// request is under way any more.
    void snapshot_all(std::chrono::steady_clock::time_point until);

  private:
    using Clock = std::chrono::steady_clock;

    void run();
    bool snapshot(const std::string& id);
    void end_unused();

    Services& services_;
    std::mutex mutex_;  ///< guards the next three
    std::condition_variable woken_;
    std::deque<std::string> due_;
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace tinsmith::server
