// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/two_processors.hpp"

#include <atomic>
#include <cstddef>
#include <stdexcept>

#include <pthread.h>
#include <sched.h>

namespace tinsmith::bench {

namespace {

struct Pile {
    std::span<const core::Job> jobs;
    std::atomic<std::size_t> next{0};

    void work() {
        for (std::size_t i = next++; i < jobs.size(); i = next++)
            jobs[i]();
    }
};

void* work_on(void* pile) {
    static_cast<Pile*>(pile)->work();
    return nullptr;
}

/// A thread that begins on that processor, rather than is moved there.
pthread_t start_on(int processor, Pile& pile) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(processor), &set);
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setaffinity_np(&attributes, sizeof set, &set);
    pthread_t thread{};
    const int failed = pthread_create(&thread, &attributes, work_on, &pile);
    pthread_attr_destroy(&attributes);
    if (failed != 0) throw std::runtime_error("there are no two processors");
    return thread;
}

}  // namespace

void on_two_processors(std::span<const core::Job> jobs) {
    Pile pile{jobs};
    const pthread_t helper = start_on(sched_getcpu() == 0 ? 1 : 0, pile);
    pile.work();
    pthread_join(helper, nullptr);
}

}  // namespace tinsmith::bench
