// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace tinsmith::e2e {

using BenchClock = std::chrono::steady_clock;

inline double milliseconds_since(BenchClock::time_point start) {
    return std::chrono::duration<double, std::milli>(BenchClock::now() - start).count();
}

/// The value that so many of them are not above; 0: there are none.
inline double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place),
                     values.end());
    return values[place];
}

/// What the figures were had on.
inline void print_machine() {
    std::string model = "unknown processor";
    std::ifstream processors("/proc/cpuinfo");
    for (std::string line; std::getline(processors, line);)
        if (line.starts_with("model name")) model = line.substr(line.find(':') + 2);
    std::string load;
    std::getline(std::ifstream("/proc/loadavg"), load);
    const std::time_t now = std::time(nullptr);
    char day[32] = "";
    std::strftime(day, sizeof day, "%Y-%m-%d %H:%M", std::gmtime(&now));
    std::printf("%s UTC, %u x %s, load before: %s\n", day, std::thread::hardware_concurrency(),
                model.c_str(), load.c_str());
}

}  // namespace tinsmith::e2e
