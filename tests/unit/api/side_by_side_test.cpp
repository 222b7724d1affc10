// SPDX-License-Identifier: Apache-2.0
#include "api/side_by_side.hpp"

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

TEST(SideBySide, DoesEachJobOnce) {
    std::vector<std::atomic<int>> done(100);
    std::vector<core::Job> jobs;
    for (std::atomic<int>& count : done)
        jobs.emplace_back([&count] { ++count; });
    side_by_side(jobs);
    for (const std::atomic<int>& count : done)
        EXPECT_EQ(count, 1);
    side_by_side({});
}

TEST(SideBySide, ThrowsWhatTheFirstOfThemThrewAndDoesTheOthers) {
    std::atomic<int> done{0};
    const auto fail = [](const char* what) { throw std::runtime_error(what); };
    const std::vector<core::Job> jobs{[&] { ++done; }, [&] { fail("second"); }, [&] { ++done; },
                                      [&] { fail("fourth"); }};
    try {
        side_by_side(jobs);
        FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
        EXPECT_EQ(std::string(error.what()), "second");
    }
    EXPECT_EQ(done, 2);
}

TEST(SideBySide, JobsMayHaveJobs) {
    std::atomic<int> done{0};
    const std::vector<core::Job> inner(3, [&] { ++done; });
    const std::vector<core::Job> outer(4, [&] { side_by_side(inner); });
    side_by_side(outer);
    EXPECT_EQ(done, 12);
}

}  // namespace
}  // namespace tinsmith::api
