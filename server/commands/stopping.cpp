// SPDX-License-Identifier: Apache-2.0
#include "server/commands/stopping.hpp"

#include <cstdlib>

#include "server/config.hpp"
#include "server/log.hpp"

namespace tinsmith::server {

StopSignals::StopSignals(bool hangup) {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    if (hangup) sigaddset(&set_, SIGHUP);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    // A file that may not grow (ulimit -f) is an error of the write, as a full disk is.
    std::signal(SIGXFSZ, SIG_IGN);
}

void StopSignals::wait(const std::function<void()>& on_hangup) const {
    for (;;) {
        int signal = 0;
        sigwait(&set_, &signal);
        if (signal != SIGHUP) return;
        if (on_hangup) on_hangup();
    }
}

void StopSignals::release() const {
    if (sigismember(&set_, SIGHUP) == 1) std::signal(SIGHUP, SIG_IGN);  // nothing to read for
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
