// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/timing.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <malloc.h>
#include <time.h>

namespace tinsmith::bench {

namespace {

double clock_ms(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace

double now_ms() {
    return clock_ms(CLOCK_THREAD_CPUTIME_ID);
}

double wall_ms() {
    return clock_ms(CLOCK_MONOTONIC);
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

double least(const std::vector<double>& values) {
    return *std::ranges::min_element(values);
}

std::string ratio(const std::vector<double>& over, const std::vector<double>& under) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < under.size(); ++i)
        ratios.push_back(over[i] / under[i]);
    std::ranges::sort(ratios);
    char text[64];
    std::snprintf(text, sizeof text, "%.2f (%.2f-%.2f)", median(ratios), ratios[ratios.size() / 4],
                  ratios[ratios.size() * 3 / 4]);
    return text;
}

int run_program(const char* name, int count, char** arguments, int usual_runs,
                int (*run)(const std::string& part, int runs)) {
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, -1);
    mallopt(M_ARENA_MAX, 1);  // those of threads are given back whatever is said
    try {
        const int runs = count > 2 ? std::atoi(arguments[2]) : usual_runs;
        return run(count > 1 ? arguments[1] : "", std::max(runs, 1));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", name, error.what());
        return EXIT_FAILURE;
    }
}

}  // namespace tinsmith::bench
