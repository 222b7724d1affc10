// SPDX-License-Identifier: Apache-2.0
#include "server/trace_context.hpp"

#include <gtest/gtest.h>

namespace tinsmith::server {
namespace {

TEST(TraceContext, IsReadToTheLetter) {
    const std::string text = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01";
    const auto trace = parse_traceparent(text);
    ASSERT_TRUE(trace);
    EXPECT_EQ(trace->trace_id, "0af7651916cd43dd8448eb211c80319c");
    EXPECT_EQ(trace->parent_id, "b7ad6b7169203331");
    EXPECT_EQ(trace->flags, "01");
    EXPECT_EQ(trace->text(), text);
}

TEST(TraceContext, IsNothingWhereInvalid) {
    for (const char* text : {
             "",
             "00",
             "01-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01",
             "ff-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01",
             "00-0AF7651916CD43DD8448EB211C80319C-b7ad6b7169203331-01",
             "00-00000000000000000000000000000000-b7ad6b7169203331-01",
             "00-0af7651916cd43dd8448eb211c80319c-0000000000000000-01",
             "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-0g",
             "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01-x",
             "00-0af7651916cd43dd8448eb211c80319c_b7ad6b7169203331-01",
             "00-0af7651916cd43dd8448eb211c8031\n\n-b7ad6b7169203331-01",
             " 00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-0",
         }) {
        EXPECT_FALSE(parse_traceparent(text)) << text;
    }
}

}  // namespace
}  // namespace tinsmith::server
