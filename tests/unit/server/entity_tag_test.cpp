// SPDX-License-Identifier: Apache-2.0
#include "server/entity_tag.hpp"

#include <gtest/gtest.h>

namespace tinsmith::server {
namespace {

/// "W:a|b" for `W/"a", "b"`; "?" where it is malformed.
std::string read(std::string_view field) {
    const auto list = parse_entity_tags(field);
    if (!list) return "?";
    std::string text = list->any ? "*" : "";
    for (const EntityTag& tag : list->tags)
        text += (text.empty() ? "" : "|") + std::string(tag.weak ? "W:" : "") + tag.opaque;
    return text;
}

TEST(EntityTags, AreReadAsListed) {
    EXPECT_EQ(read("\"a\""), "a");
    EXPECT_EQ(read("\"a\",W/\"b\" ,\t\"c\""), "a|W:b|c");
    EXPECT_EQ(read(" , \"a\",, "), "a");
    EXPECT_EQ(read("\"a,b\""), "a,b");
    EXPECT_EQ(read("\"\""), "");
    EXPECT_EQ(read(""), "");
    EXPECT_EQ(read(" * "), "*");
    EXPECT_EQ(read("\"\xc3\xa9\""), "\xc3\xa9");
}

TEST(EntityTags, AreRefusedWhereMalformed) {
    for (const char* field : {"a", "\"a", "a\"", "W/a", "w/\"a\"", "\"a\" \"b\"", "*, \"a\"",
                              "\"a\", *", "**", "*,*", "\"a b\"", "\"a\"b", "W/", "'a'"}) {
        EXPECT_EQ(read(field), "?") << field;
    }
}

TEST(EntityTags, AreCombinedFromAllFields) {
    Request request;
    EXPECT_FALSE(combined_field(request, "if-match"));
    request.headers = {{"if-match", "\"a\""}, {"x", "y"}, {"if-match", "\"b\""}};
    EXPECT_EQ(combined_field(request, "if-match"), "\"a\", \"b\"");
}

}  // namespace
}  // namespace tinsmith::server
