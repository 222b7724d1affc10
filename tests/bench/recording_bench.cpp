// SPDX-License-Identifier: Apache-2.0
// What figures cost: nanoseconds that one request more takes to be counted, alone and beside other
// threads that count the same. Usage: recording_bench
#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>

#include "server/metrics/metrics.hpp"

namespace {

using tinsmith::server::Metrics;
using tinsmith::server::RouteMeter;
using Clock = std::chrono::steady_clock;

constexpr int kRounds = 2'000'000;

/// What serve.cpp does for each request, and nothing else.
void count_requests(Metrics& metrics, const RouteMeter& route) {
    for (int i = 0; i < kRounds; ++i) {
        const Metrics::InFlight one(metrics);
        metrics.request(&route, "GET", 200, 1e-4 * (i % 64), 100, 1000);
    }
}

/// Of one request on one thread, while so many do the same.
double nanoseconds(int threads) {
    Metrics metrics;
    const RouteMeter& route = metrics.route("/v1/sessions/{id}");
    const auto start = Clock::now();
    std::vector<std::thread> others;
    for (int i = 1; i < threads; ++i)
        others.emplace_back([&] { count_requests(metrics, route); });
    count_requests(metrics, route);
    for (std::thread& other : others)
        other.join();
    return std::chrono::duration<double, std::nano>(Clock::now() - start).count() / kRounds;
}

}  // namespace

int main() {
    for (const int threads : {1, 2, 4})
        std::printf("%d threads: %.0f ns a request\n", threads, nanoseconds(threads));
}
