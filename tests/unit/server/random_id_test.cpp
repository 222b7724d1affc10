// SPDX-License-Identifier: Apache-2.0
#include "server/random_id.hpp"

#include <set>

#include <gtest/gtest.h>

namespace tinsmith::server {
namespace {

TEST(RandomUuid, HasTheFormOfVersionFour) {
    std::set<std::string> seen;
    for (int i = 0; i < 200; ++i) {
        const std::string id = random_uuid();
        ASSERT_EQ(id.size(), 36U);
        EXPECT_EQ(id[8], '-');
        EXPECT_EQ(id[13], '-');
        EXPECT_EQ(id[14], '4');
        EXPECT_EQ(id[18], '-');
        EXPECT_NE(std::string("89ab").find(id[19]), std::string::npos) << id;
        EXPECT_EQ(id[23], '-');
        EXPECT_TRUE(is_sane_id(id));
        seen.insert(id);
    }
    EXPECT_EQ(seen.size(), 200U);
}

TEST(SaneId, AllowsNothingThatCouldBreakALine) {
    EXPECT_TRUE(is_sane_id("a"));
    EXPECT_TRUE(is_sane_id("Az09._-"));
    EXPECT_TRUE(is_sane_id(std::string(64, 'x')));
    EXPECT_FALSE(is_sane_id(""));
    EXPECT_FALSE(is_sane_id(std::string(65, 'x')));
    for (const char* id : {"a b", "a\n", "a\"", "\xc3\xa9", "a/b", "a:b"}) {
        EXPECT_FALSE(is_sane_id(id));
    }
}

}  // namespace
}  // namespace tinsmith::server
