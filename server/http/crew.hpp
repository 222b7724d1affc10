// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "server/http/reception.hpp"

namespace tinsmith::server {

/// The threads that serve what has arrived, in the order in which it came.
class Crew {
  public:
    using Serve = std::function<void(Arrival)>;

    Crew(std::size_t threads, Serve serve);
    ~Crew() { finish(); }
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

    /// From any thread. False: too much waits already, or it has finished, and the arrival is as it
    /// was.
    bool add(Arrival& arrival);

    /// Serves what has been added, then ends the threads. Once or more, from one thread that is
    /// none of them.
    void finish();

    /// Whether some that have arrived wait for a thread.
    bool is_behind() const { return waiting_ > 0; }
    /// Whether a thread may do without work for a moment and nobody would miss it.
    bool has_spare() const { return !is_behind() && busy_ <= threads_.size() / 2; }

  private:
    /// What waits may hold so much together. (What serves takes one request at a time.)
    static constexpr std::size_t kMaxQueuedBytes = std::size_t{8} << 20;

    void work();
    void serve_alone(Arrival arrival) noexcept;

    const Serve serve_;
    std::atomic<std::size_t> waiting_{0};
    std::atomic<std::size_t> busy_{0};  ///< threads that serve
    std::mutex mutex_;                  ///< guards the next
    std::condition_variable changed_;
    std::deque<Arrival> arrivals_;
    std::size_t bytes_ = 0;  ///< that they hold
    bool finishing_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace tinsmith::server
