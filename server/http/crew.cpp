// SPDX-License-Identifier: Apache-2.0
#include "server/http/crew.hpp"

#include <exception>
#include <utility>

#include "server/log.hpp"

namespace tinsmith::server {

Crew::Crew(std::size_t threads, Serve serve) : serve_(std::move(serve)) {
    threads_.reserve(threads);
    try {
        while (threads_.size() < threads)
            threads_.emplace_back([this] { work(); });
    } catch (...) {
        finish();
        throw;
    }
}

bool Crew::add(Arrival& arrival) {
    {
        const std::lock_guard lock(mutex_);
        const std::size_t bytes = arrival.connection->unread().size();
        if (finishing_ || bytes_ + bytes > kMaxQueuedBytes) return false;
        arrivals_.push_back(std::move(arrival));
        waiting_ = arrivals_.size();
        bytes_ += bytes;
    }
    changed_.notify_one();
    return true;
}

void Crew::finish() {
    {
        const std::lock_guard lock(mutex_);
        finishing_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_)
        if (thread.joinable()) thread.join();
}

/// What a request does to its thread ends with it; its connection is closed.
void Crew::serve_alone(Arrival arrival) noexcept {
    try {
        serve_(std::move(arrival));
    } catch (const std::exception& failure) {
        try {
            log_event(LogLevel::Error, "defect", failure.what());
        } catch (...) {
            // No memory for that either.
        }
    }
}

void Crew::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return finishing_ || !arrivals_.empty(); });
        if (arrivals_.empty()) return;
        Arrival arrival = std::move(arrivals_.front());
        arrivals_.pop_front();
        waiting_ = arrivals_.size();
        bytes_ -= arrival.connection->unread().size();
        ++busy_;
        lock.unlock();
        serve_alone(std::move(arrival));
        lock.lock();
        --busy_;
    }
}

}  // namespace tinsmith::server
