// SPDX-License-Identifier: Apache-2.0
#include "api/side_by_side.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace tinsmith::api {
namespace {

/// Crew that may still be taken.
std::atomic<int>& free_helpers() {
    static std::atomic<int> count{
        static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U)) - 1};
    return count;
}

bool take_helper() {
    int left = free_helpers();
    while (left > 0) {
        if (free_helpers().compare_exchange_weak(left, left - 1)) return true;
    }
    return false;
}

/// Jobs that any of several threads takes, each once, in their order.
class Pile {
  public:
    explicit Pile(std::span<const core::Job> jobs) : jobs_(jobs), thrown_(jobs.size()) {}

    void work() {
        for (std::size_t i = next_++; i < jobs_.size(); i = next_++) {
            try {
                jobs_[i]();
            } catch (...) {
                thrown_[i] = std::current_exception();
            }
        }
    }

    void rethrow() const {
        for (const std::exception_ptr& thrown : thrown_) {
            if (thrown) std::rethrow_exception(thrown);
        }
    }

  private:
    std::span<const core::Job> jobs_;
    std::vector<std::exception_ptr> thrown_;
    std::atomic<std::size_t> next_{0};
};

/// Threads that work on a pile until its jobs are taken.
class Crew {
  public:
    Crew(Pile& pile, std::size_t most) {
        threads_.reserve(most);
        while (threads_.size() < most && take_helper()) {
            try {
                threads_.emplace_back([&pile] { pile.work(); });
            } catch (const std::exception&) {  // the caller goes on with those there are
                ++free_helpers();
                return;
            }
        }
    }
    ~Crew() {
        for (std::thread& thread : threads_) {
            thread.join();
            ++free_helpers();
        }
    }
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

  private:
    std::vector<std::thread> threads_;
};

}  // namespace

void side_by_side(std::span<const core::Job> jobs) {
    if (jobs.size() < 2) return core::one_after_another(jobs);
    Pile pile(jobs);
    {
        const Crew crew(pile, jobs.size() - 1);
        pile.work();
    }
    pile.rethrow();
}

}  // namespace tinsmith::api
