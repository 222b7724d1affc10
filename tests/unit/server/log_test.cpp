// SPDX-License-Identifier: Apache-2.0
#include "server/log.hpp"

#include <gtest/gtest.h>

namespace tinsmith::server {
namespace {

TEST(Sanitized, LeavesNoWayToForgeALine) {
    EXPECT_EQ(sanitized("/v1/a b"), "/v1/a b");
    EXPECT_EQ(sanitized("a\nb\r\x1b[31m\"\\\x7f\xff"), "a\\x0ab\\x0d\\x1b[31m\\x22\\x5c\\x7f\\xff");
    EXPECT_EQ(sanitized(std::string(300, 'a')), std::string(200, 'a') + "...");
}

}  // namespace
}  // namespace tinsmith::server
