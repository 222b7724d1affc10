// SPDX-License-Identifier: Apache-2.0
// What several askers keep in one place.
#include <string>
#include <thread>
#include <variant>

#include <gtest/gtest.h>

#include "server/jobs.hpp"
#include "server/log.hpp"
#include "server/reply.hpp"

namespace tinsmith::server {
namespace {

TEST(JobsOfMany, AreNotLostToOthersWhoKeepMore) {
    set_log_level(LogLevel::Off);
    Jobs jobs({.threads = 1, .kept = 10, .bytes = 100'000});
    const auto ended_for = [&](const std::string& owner, std::size_t bytes) {
        Request request;
        request.method = "POST";
        request.body.assign(bytes, 'x');
        request.asker.id = owner;
        const auto job = jobs.add(std::move(request),
                                  [](const Request& of) { return ok("text/plain", of.body); });
        while (std::holds_alternative<Jobs::Unfinished>(jobs.result(job.value().id)))
            std::this_thread::yield();
        return job->id;
    };
    const std::string small = ended_for("alice", 100);
    std::string first, last;
    for (int i = 0; i < 30; ++i) {
        last = ended_for("bob", 100);
        if (first.empty()) first = last;
    }
    EXPECT_TRUE(jobs.view(small)) << "there are too many of bob's";
    EXPECT_FALSE(jobs.view(first));
    EXPECT_TRUE(jobs.view(last));
    for (int i = 0; i < 5; ++i)
        last = ended_for("bob", 40'000);
    EXPECT_TRUE(jobs.view(small)) << "bob's are too large";
    EXPECT_TRUE(jobs.view(last));
    const std::string large = ended_for("alice", 30'000);
    EXPECT_TRUE(jobs.view(large));
    EXPECT_TRUE(jobs.view(small)) << "bob still had most of the bytes";
    set_log_level(LogLevel::Info);
}

}  // namespace
}  // namespace tinsmith::server
