// SPDX-License-Identifier: Apache-2.0
#include "server/http/pace.hpp"

#include <gtest/gtest.h>

namespace tinsmith::server {
namespace {

using std::chrono::seconds;

TEST(Pace, HasPatienceAndThenWantsItsBytes) {
    const Pace pace(seconds(10), 1000);
    const auto ago = [](int count) { return Pace::Clock::now() - seconds(count); };
    EXPECT_FALSE(pace.is_too_slow(ago(5), 0));
    EXPECT_TRUE(pace.is_too_slow(ago(11), 0));
    EXPECT_FALSE(pace.is_too_slow(ago(60), 55'000));
    EXPECT_TRUE(pace.is_too_slow(ago(60), 45'000));
}

}  // namespace
}  // namespace tinsmith::server
