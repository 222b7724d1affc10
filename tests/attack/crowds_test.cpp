// SPDX-License-Identifier: Apache-2.0
// Very many: connections that say nothing, sessions that nobody needs.
#include <iostream>
#include <list>

#include <gtest/gtest.h>

#include "tests/attack/victim.hpp"
#include "tests/durability/steady_client.hpp"

namespace tinsmith::e2e {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kSpareDescriptors = 200;
const std::string kJson = "Content-Type: application/json";
const std::string kTriangle =
    R"({"mesh":{"vertices":[[0,0,0],[1,0,0],[0,1,0]],"triangles":[[0,1,2]]}})";

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

TEST(Crowd, OfIdleConnections) {
    const std::size_t wanted = is_long_form() ? 10'000 : 500;
    const std::size_t allowed = allow_descriptors(wanted + kSpareDescriptors);
    if (allowed < wanted + kSpareDescriptors) {
        GTEST_SKIP() << "the system allows " << allowed << " descriptors; " << wanted
                     << " connections need more (RLIMIT_NOFILE)";
    }
    Victim victim;
    ASSERT_NE(victim.port(), 0);
    {
        std::list<Connection> all;
        for (std::size_t i = 0; i < wanted; ++i)
            all.emplace_back(victim.port()).send(i % 2 == 0 ? "" : "GET /v1/limits HT");
        if (is_long_form()) {
            const auto start = Clock::now();
            Connection honest(victim.port(), 60);
            honest.send(request_text("GET", "/healthz"));
            const int status = honest.read().status;
            std::cout << wanted << " idle connections: meanwhile a client waited "
                      << seconds_since(start) << " s for status " << status << "\n";
        }
    }
    EXPECT_EQ(victim.harm_at_the_end(), "");
}

TEST(Crowd, OfConnectionsThatComeAndGo) {
    Victim victim;
    ASSERT_NE(victim.port(), 0);
    const int count = is_long_form() ? 100'000 : 2000;
    for (int i = 0; i < count; ++i)
        const Connection gone(victim.port());
    EXPECT_EQ(victim.harm_at_the_end(), "");
}

TEST(Crowd, OfSessions) {
    const std::size_t most = is_long_form() ? 10'000 : 64;
    Victim victim({"--max-sessions", std::to_string(most)});
    ASSERT_NE(victim.port(), 0);
    SteadyClient client(victim.port());
    const auto start = Clock::now();
    for (std::size_t made = 1; made < most; ++made)  // one is there already
        ASSERT_EQ(client.ask("POST", "/v1/sessions", {kJson}, kTriangle).status, 201) << made;
    std::cout << most << " sessions: " << seconds_since(start) << " s, " << victim.growth()
              << " MiB\n";
    victim.watch_memory();
    for (int i = 0; i < 500; ++i) {
        const Answer answer = client.ask("POST", "/v1/sessions", {kJson}, kTriangle);
        ASSERT_EQ(answer.status, 429);
        ASSERT_NE(answer.body.find("max_sessions"), std::string::npos) << answer.body;
        ASSERT_EQ(client.ask("POST", "/v1/sessions/honest/fork").status, 429);
    }
    EXPECT_EQ(victim.harm_at_the_end(), "");
}

}  // namespace
}  // namespace tinsmith::e2e
