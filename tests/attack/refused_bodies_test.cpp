// SPDX-License-Identifier: Apache-2.0
// Large bodies that are refused, again and again and at the same time: what they took goes back to
// the system, and those that the head condemns are never read.
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/attack/victim.hpp"

namespace tinsmith::e2e {
namespace {

constexpr std::size_t kMega = 1'000'000;
constexpr int kClients = 8;

/// `rounds` times from each of so many clients. Returns how many were answered otherwise.
int refused_otherwise(int port, const std::string& request, int status, int rounds) {
    std::atomic<int> others{0};
    std::vector<std::thread> clients;
    for (int i = 0; i < kClients; ++i) {
        clients.emplace_back([&] {
            for (int round = 0; round < rounds; ++round) {
                Connection connection(port, 60);
                connection.try_send(request);  // the server may have closed by then
                if (connection.read().status != status) ++others;
            }
        });
    }
    for (std::thread& client : clients)
        client.join();
    return others;
}

class RefusedBodies : public testing::Test {
  protected:
    void SetUp() override { ASSERT_NE(victim_.port(), 0); }
    void TearDown() override { EXPECT_EQ(victim_.server().stop(), ""); }

    int rounds() const { return is_long_form() ? 20 : 3; }

    void refuse(const std::string& method, const std::string& target, std::size_t size,
                int status) {
        SCOPED_TRACE(method + " " + target + " " + std::to_string(size));
        const std::string request = request_text(method, target, {"Content-Type: application/json"},
                                                 std::string(size, 'x'));
        EXPECT_EQ(refused_otherwise(victim_.port(), request, status, rounds()), 0);
    }

    /// An answer is sent before what its request held is given back.
    bool comes_to_hold_little() const {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
        while (victim_.growth_that_stays() > kMostMebiForRefused) {
            if (std::chrono::steady_clock::now() > end) return false;
            std::this_thread::yield();
        }
        return true;
    }

    Victim victim_;
};

TEST_F(RefusedBodies, AreNotReadWhereTheHeadCondemnsThem) {
    for (const std::size_t size : {4 * kMega, 30 * kMega}) {
        refuse("POST", "/nope", size, 404);
        refuse("PUT", "/v1/sessions/honest/polygons", size, 405);
        refuse("POST", "/v1/sessions?colour=red", size, 400);
    }
    EXPECT_EQ(victim_.harm(), "");
}

TEST_F(RefusedBodies, LeaveNothingBehind) {
    for (const std::size_t size : {4 * kMega, 30 * kMega}) {
        refuse("POST", "/v1/sessions", size, 400);
        EXPECT_TRUE(comes_to_hold_little())
            << "after bodies of " << size << ": " << victim_.growth_that_stays() << " MiB";
    }
}

}  // namespace
}  // namespace tinsmith::e2e
