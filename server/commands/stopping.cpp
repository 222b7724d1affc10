// SPDX-License-Identifier: Apache-2.0
#include "server/commands/stopping.hpp"

#include <cstdlib>

#include "server/config.hpp"
#include "server/log.hpp"

namespace tinsmith::server {

StopSignals::StopSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    // A file that may not grow (ulimit -f) is an error of the write, as a full disk is.
    std::signal(SIGXFSZ, SIG_IGN);
}

void StopSignals::wait() const {
    int signal = 0;
    sigwait(&set_, &signal);
}

void StopSignals::release() const {
    pthread_sigmask(SIG_UNBLOCK, &set_, nullptr);
}

Watchdog::Watchdog(Time end)
    : thread_([this, end] {
          std::unique_lock lock(mutex_);
          if (changed_.wait_until(lock, end, [this] { return over_; })) return;
          log_event(LogLevel::Warning, "stop_forced",
                    "stopped with work under way, which did not end in time");
          std::_Exit(kExitOk);
      }) {}

Watchdog::~Watchdog() {
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

}  // namespace tinsmith::server
