// SPDX-License-Identifier: Apache-2.0
#include "server/target.hpp"

#include <gtest/gtest.h>

namespace tinsmith::server {
namespace {

using Segments = std::vector<std::string>;

TEST(ParseTarget, SplitsPathAndQueryInOrder) {
    const auto target = parse_target("/v1/x?b=2&a=1&&flag&b=%26+%2B#part");
    ASSERT_TRUE(target);
    EXPECT_EQ(target->path, "/v1/x");
    const std::vector<NameValue> expected{{"b", "2"}, {"a", "1"}, {"flag", ""}, {"b", "& +"}};
    EXPECT_EQ(target->query, expected);
}

TEST(ParseTarget, RefusesWhatIsBroken) {
    for (const char* text : {"", "v1", "*", "http://host/", "/%", "/%4", "/%zz", "/a%00b", "/?x=%1",
                             "/?%0a=1", "/a%0d%0aSet-Cookie:x"}) {
        EXPECT_FALSE(parse_target(text)) << text;
    }
}

TEST(SplitPath, DecodesEachSegmentByItself) {
    EXPECT_EQ(split_path("/"), Segments{});
    EXPECT_EQ(split_path("/v1/sessions"), (Segments{"v1", "sessions"}));
    EXPECT_EQ(split_path("/a%2Fb/c+d%20e"), (Segments{"a/b", "c+d e"}));
    EXPECT_EQ(split_path("/a/"), (Segments{"a", ""}));
    EXPECT_EQ(split_path("//a"), (Segments{"", "a"}));
    EXPECT_EQ(split_path("/../a"), (Segments{"..", "a"}));
}

}  // namespace
}  // namespace tinsmith::server
