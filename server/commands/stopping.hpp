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
/// them: no code of ours runs in a signal handler before `release`. SIGXFSZ is ignored, and SIGUSR1
/// is ours. With `hangup` SIGHUP is taken off them too, and means that something is to be read
/// again.
class StopSignals {
  public:
    explicit StopSignals(bool hangup = false);

    /// Until one of them comes, or `wake`. Calls `on_hangup` here at each SIGHUP.
    void wait(const std::function<void()>& on_hangup = {}) const;
    /// Ends the wait, or nothing where it has ended. From any thread.
    static void wake();

    /// From now on SIGINT and SIGTERM end the process at once, with exit code 128 + the signal: for
    /// those who press Ctrl-C twice. That holds for the first process of a container too.
    void release() const;

  private:
    sigset_t stopping_{};
    sigset_t all_{};
};

/// Ends the process when it still lives at a time, whatever it does and whoever holds the log: what
/// stops it has a bound. Requires: nothing that was acknowledged is lost by an end at any moment.
class Watchdog {
  public:
    using Time = std::chrono::steady_clock::time_point;

    Watchdog() = default;
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// Once.
    void start(Time end, int exit_code);

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool over_ = false;
    std::thread thread_;
};

}  // namespace tinsmith::server
