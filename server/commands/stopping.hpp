// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <functional>
#include <mutex>
#include <thread>

namespace tinsmith::server {

/// How long the process may live after the grace, for what cannot give up: an encoding under way, a
/// file that does not come, snapshots.
inline constexpr std::chrono::seconds kLastWait{5};

/// SIGINT and SIGTERM, taken off every thread that is started later so that only `wait` meets
/// them: no code of ours runs in a signal handler. SIGXFSZ is ignored. With `hangup` SIGHUP is
/// taken off them too, and means that something is to be read again.
class StopSignals {
  public:
    explicit StopSignals(bool hangup = false);

    /// Returns when it is to stop. Calls `on_hangup` here at each SIGHUP.
    void wait(const std::function<void()>& on_hangup = {}) const;

    /// From now on they end the process at once: for those who press Ctrl-C twice.
    void release() const;

  private:
    sigset_t set_{};
};

/// Ends the process with exit code 0 when it still lives at that time, whatever it does: what
/// stops it has a bound. Requires: nothing that was acknowledged is lost by an end at any moment.
class Watchdog {
  public:
    using Time = std::chrono::steady_clock::time_point;

    explicit Watchdog(Time end);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool over_ = false;
    std::thread thread_;
};

}  // namespace tinsmith::server
