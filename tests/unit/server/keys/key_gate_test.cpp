// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "server/keys/gate.hpp"

namespace tinsmith::server {
namespace {

class KeyGate : public ::testing::Test {
  protected:
    Request request(const std::string& path = "/v1/sessions") const {
        Request made;
        made.method = "GET";
        made.path = path;
        made.headers.emplace_back("authorization", "Bearer " + key);
        return made;
    }
    void allow(const KeyQuotas& quotas) {
        ring.replace({{"alice", "01", hash_of_key(key), "", quotas}});
    }
    static std::string seconds(const Response& response) {
        for (const auto& [name, value] : response.headers)
            if (name == "Retry-After") return value;
        return "";
    }

    const std::string key = new_key();
    Gate::Time now{};
    KeyRing ring;
    Gate gate{ring, [this] { return now; }};
};

TEST_F(KeyGate, AsksNobodyWhereThereAreNoKeys) {
    Request made = request();
    made.headers.clear();
    EXPECT_FALSE(gate.admit(made));
    EXPECT_EQ(made.asker.id, "");
    allow({});
    EXPECT_TRUE(gate.admit(made));
}

TEST_F(KeyGate, SaysWhoAsks) {
    allow({});
    Request made = request(), page = request("/docs");
    EXPECT_FALSE(gate.admit(made));
    EXPECT_EQ(made.asker.name, "alice");
    EXPECT_EQ(made.asker.id, "01");
    EXPECT_FALSE(gate.admit(page));
    EXPECT_EQ(page.asker.id, "") << "who reads what is for everyone need not be known";
}

TEST_F(KeyGate, CountsRequestsInFlight) {
    allow({.max_requests = 2});
    std::vector<Request> under_way(2, request());
    for (Request& one : under_way)
        EXPECT_FALSE(gate.admit(one));
    Request third = request();
    const auto refused = gate.admit(third);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->status, 429);
    EXPECT_NE(refused->body.find("quota max_requests of this key is 2"), std::string::npos);
    EXPECT_EQ(seconds(*refused), "1");
    const Request copy = under_way.back();
    under_way.pop_back();
    EXPECT_TRUE(gate.admit(third)) << "a copy is under way still";
    under_way.clear();
    third = request();
    EXPECT_FALSE(gate.admit(third));
}

TEST_F(KeyGate, CountsRequestsInASecond) {
    allow({.max_requests_per_second = 2.0});
    const auto is_let_in = [this] {
        Request one = request();
        return !gate.admit(one);
    };
    EXPECT_TRUE(is_let_in());
    EXPECT_TRUE(is_let_in());
    Request third = request();
    const auto refused = gate.admit(third);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->status, 429);
    EXPECT_NE(refused->body.find("quota max_requests_per_second of this key is 2,"),
              std::string::npos);
    EXPECT_EQ(seconds(*refused), "1");
    now += std::chrono::milliseconds(500);
    EXPECT_TRUE(is_let_in());
    EXPECT_FALSE(is_let_in());
    now += std::chrono::hours(1);
    EXPECT_TRUE(is_let_in());
    EXPECT_TRUE(is_let_in());
    EXPECT_FALSE(is_let_in()) << "an hour of silence is no hour's worth at once";
}

TEST_F(KeyGate, LetsInOneInSeveralSeconds) {
    allow({.max_requests_per_second = 0.1});
    Request first = request(), second = request();
    EXPECT_FALSE(gate.admit(first));
    const auto refused = gate.admit(second);
    ASSERT_TRUE(refused);
    EXPECT_EQ(seconds(*refused), "10");
    now += std::chrono::seconds(10);
    EXPECT_FALSE(gate.admit(second));
}

TEST_F(KeyGate, CountsRightlyOnManyThreads) {
    allow({.max_requests = 1000});
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([this] {
            for (int j = 0; j < 500; ++j) {
                Request one = request();
                EXPECT_FALSE(gate.admit(one));
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    allow({.max_requests = 1});
    Request one = request(), other = request();
    EXPECT_FALSE(gate.admit(one)) << "all the others have ended";
    EXPECT_TRUE(gate.admit(other));
}

}  // namespace
}  // namespace tinsmith::server
