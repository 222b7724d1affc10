// SPDX-License-Identifier: Apache-2.0
#include "server/http/crew.hpp"

#include <utility>

namespace tinsmith::server {

Crew::Crew(std::size_t threads, Serve serve) : serve_(std::move(serve)) {
    threads_.reserve(threads);
    const std::lock_guard lock(mutex_);  // they begin once all are there
    for (std::size_t i = 0; i < threads; ++i)
        threads_.emplace_back([this] { work(); });
}

void Crew::add(Arrival arrival) {
    {
        const std::lock_guard lock(mutex_);
        if (finishing_) return;
        arrivals_.push_back(std::move(arrival));
        waiting_ = arrivals_.size();
    }
    changed_.notify_one();
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

void Crew::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return finishing_ || !arrivals_.empty(); });
        if (arrivals_.empty()) return;
        Arrival arrival = std::move(arrivals_.front());
        arrivals_.pop_front();
        waiting_ = arrivals_.size();
        ++busy_;
        lock.unlock();
        serve_(std::move(arrival));
        lock.lock();
        --busy_;
    }
}

}  // namespace tinsmith::server
