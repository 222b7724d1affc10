// SPDX-License-Identifier: Apache-2.0
// Clients that send or read next to nothing for as long as they may: they hold threads, but no
// memory, and nothing of them stays.
#include <chrono>
#include <list>
#include <thread>

#include <gtest/gtest.h>

#include "tests/attack/victim.hpp"
#include "tests/durability/random_shapes.hpp"

namespace tinsmith::e2e {
namespace {

using Clock = std::chrono::steady_clock;

const std::string kJson = "Content-Type: application/json";

class SlowAttack : public testing::Test {
  protected:
    void SetUp() override { ASSERT_NE(victim_.port(), 0); }

    std::list<Connection> crowd(int count, const std::string& bytes) {
        std::list<Connection> all;
        for (int i = 0; i < count; ++i)
            all.emplace_back(victim_.port()).send(bytes);
        return all;
    }

    static void drip(std::list<Connection>& all, const std::string& bytes, int seconds) {
        for (const auto end = Clock::now() + std::chrono::seconds(seconds); Clock::now() < end;) {
            for (const Connection& connection : all)
                connection.send(bytes);
            std::this_thread::sleep_for(std::chrono::milliseconds(200));
        }
    }

    static int seconds() { return is_long_form() ? 60 : 2; }

    const int crowd_ = is_long_form() ? 1000 : 100;
    Victim victim_;
};

TEST_F(SlowAttack, Heads) {
    auto all = crowd(crowd_, "GET /v1/limits HTTP/1.1\r\nHost: x\r\n");
    drip(all, "X-A: b\r\n", seconds());
    all.clear();
    EXPECT_EQ(victim_.harm_at_the_end(), "");
}

TEST_F(SlowAttack, Bodies) {
    auto all = crowd(crowd_, "POST /v1/sessions HTTP/1.1\r\nHost: x\r\n" + kJson +
                                 "\r\nContent-Length: 100000000\r\n\r\n{");
    drip(all, " ", seconds());
    all.clear();
    EXPECT_EQ(victim_.harm_at_the_end(), "");
}

/// Large answers that nobody reads. Each is a copy, so there are as many as there are threads.
TEST_F(SlowAttack, Readers) {
    constexpr int kThreads = 32;
    Dice dice(3);
    ASSERT_EQ(
        ask(victim_.port(), "PUT", "/v1/sessions/large", {kJson}, grid_text(dice, 200)).status,
        201);
    const std::string request = request_text("GET", "/v1/sessions/large/mesh.json");
    const double bytes =
        static_cast<double>(ask(victim_.port(), "GET", "/v1/sessions/large/mesh.json").body.size());
    victim_.watch_memory();
    auto all = crowd(crowd_, request);
    std::this_thread::sleep_for(std::chrono::seconds(seconds()));
    all.clear();
    EXPECT_EQ(victim_.harm_at_the_end(kMostMebiForRefused + 3 * kThreads * bytes / (1 << 20)), "");
}

/// Those that say that they will send and do not.
TEST_F(SlowAttack, Invited) {
    auto all = crowd(crowd_, "POST /v1/sessions HTTP/1.1\r\nHost: x\r\n" + kJson +
                                 "\r\nContent-Length: 200000000\r\nExpect: 100-continue\r\n\r\n");
    std::this_thread::sleep_for(std::chrono::seconds(seconds()));
    all.clear();
    EXPECT_EQ(victim_.harm_at_the_end(), "");
}

/// A head that takes for ever is cut, whatever drips in.
TEST_F(SlowAttack, AHeadHasADeadline) {
    Connection slow(victim_.port());
    slow.send("GET /v1/limits HTTP/1.1\r\nHost: x\r\n");
    const auto start = Clock::now();
    bool is_cut = false;
    while (!is_cut && Clock::now() - start < std::chrono::seconds(30)) {
        is_cut = !slow.try_send("X-A: b\r\n");
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    EXPECT_TRUE(is_cut);
    EXPECT_EQ(victim_.harm_at_the_end(), "");
}

}  // namespace
}  // namespace tinsmith::e2e
