// SPDX-License-Identifier: Apache-2.0
#include "server/commands/stopping.hpp"

#include <cstdlib>
#include <future>
#include <memory>

#include <unistd.h>

#include "server/log.hpp"

namespace tinsmith::server {

namespace {

/// For which the last line of the log is waited for: nobody may read it.
constexpr std::chrono::milliseconds kLastLine{200};

constexpr int kEndedBySignal = 128;  // and the signal's number, as shells tell it

void end_at_once(int signal) {
    ::_exit(kEndedBySignal + signal);
}

void tell_forced() {
    const auto told = std::make_shared<std::promise<void>>();
    std::thread([told] {
        log_event(LogLevel::Warning, "stop_forced",
                  "stopped with work under way, which did not end in time");
        told->set_value();
    }).detach();
    told->get_future().wait_for(kLastLine);
}

}  // namespace

StopSignals::StopSignals(bool hangup) {
    sigemptyset(&stopping_);
    sigaddset(&stopping_, SIGINT);
    sigaddset(&stopping_, SIGTERM);
    all_ = stopping_;
    sigaddset(&all_, SIGUSR1);
    if (hangup) sigaddset(&all_, SIGHUP);
    pthread_sigmask(SIG_BLOCK, &all_, nullptr);
    // A file that may not grow (ulimit -f) is an error of the write, as a full disk is.
    std::signal(SIGXFSZ, SIG_IGN);
}

void StopSignals::wait(const std::function<void()>& on_hangup) const {
    for (;;) {
        int signal = 0;
        sigwait(&all_, &signal);
        if (signal != SIGHUP) return;
        if (on_hangup) on_hangup();
    }
}

void StopSignals::wake() {
    ::kill(::getpid(), SIGUSR1);
}

void StopSignals::release() const {
    // What the system does by itself it does not do to the first process of a container.
    struct sigaction action {};
    action.sa_handler = end_at_once;
    for (const int signal : {SIGINT, SIGTERM})
        ::sigaction(signal, &action, nullptr);
    pthread_sigmask(SIG_UNBLOCK, &stopping_, nullptr);
}

void Watchdog::start(Time end, int exit_code) {
    thread_ = std::thread([this, end, exit_code] {
        std::unique_lock lock(mutex_);
        if (changed_.wait_until(lock, end, [this] { return over_; })) return;
        tell_forced();
        std::_Exit(exit_code);
    });
}

Watchdog::~Watchdog() {
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

}  // namespace tinsmith::server
