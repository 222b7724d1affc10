// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <pthread.h>

#include "server/http/listener.hpp"
#include "server/http/reception.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::server {

using std::chrono::milliseconds;
using Client = e2e::Connection;

inline const std::string kGet = "GET / HTTP/1.1\r\nHost: x\r\n\r\n";

/// A reception and what has arrived at it.
class ReceptionAtWork {
  public:
    explicit ReceptionAtWork(ReceptionOptions options = {})
        : listener_(listen_on("127.0.0.1", 0)),
          reception_(listener_.socket, options, totals,
                     [this](Arrival arrival) { take(std::move(arrival)); }),
          thread_([this] { EXPECT_TRUE(reception_.run()); }) {}
    ~ReceptionAtWork() { stop(); }

    ConnectionTotals totals;

    int port() const { return listener_.port; }
    Reception& operator*() { return reception_; }

    /// Its thread waits with the next arrival until it is let go.
    void hold() { is_held_ = true; }
    void let_go() { is_held_ = false; }

    /// The processor's time of its thread.
    int clock(clockid_t& clock) { return ::pthread_getcpuclockid(thread_.native_handle(), &clock); }

    void stop() {
        let_go();
        reception_.stop();
        if (thread_.joinable()) thread_.join();
    }

    /// The next, or one without a connection where none comes for so long.
    Arrival next(milliseconds longest = milliseconds(10'000)) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, longest, [this] { return !arrived_.empty(); });
        if (arrived_.empty()) return {};
        Arrival arrival = std::move(arrived_.front());
        arrived_.pop_front();
        return arrival;
    }

  private:
    void take(Arrival arrival) {
        {
            const std::lock_guard lock(mutex_);
            arrived_.push_back(std::move(arrival));
        }
        changed_.notify_all();
        while (is_held_)
            std::this_thread::sleep_for(milliseconds(1));
    }

    std::atomic<bool> is_held_{false};
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Arrival> arrived_;
    Listener listener_;
    Reception reception_;
    std::thread thread_;
};

inline bool becomes(const std::function<bool()>& is_so) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!is_so()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::yield();
    }
    return true;
}

}  // namespace tinsmith::server
