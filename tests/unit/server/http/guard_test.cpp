// SPDX-License-Identifier: Apache-2.0
#include "server/http/guard.hpp"

#include <gtest/gtest.h>

namespace tinsmith::server {
namespace {

/// The status the guard refuses with, 0 where it lets the request pass.
int verdict(const std::string& method, std::vector<NameValue> headers,
            const std::string& path = "/v1/sessions") {
    Limits limits;
    limits.max_body_bytes = 1000;
    Request request;
    request.method = method;
    request.path = path;
    request.headers = std::move(headers);
    const auto problem = check_request_head(request, limits);
    return problem ? api::problem_status(problem->type) : 0;
}

TEST(Guard, LetsPlainRequestsPass) {
    EXPECT_EQ(verdict("GET", {}), 0);
    EXPECT_EQ(verdict("GET", {{"content-length", "0"}}), 0);
    EXPECT_EQ(verdict("DELETE", {}), 0);
    EXPECT_EQ(verdict("DELETE", {{"content-length", "5"}}), 0);
    EXPECT_EQ(verdict("POST", {}), 0) << "no length and no coding is an empty body";
    EXPECT_EQ(verdict("PUT", {}), 0);
    EXPECT_EQ(verdict("POST", {{"content-length", "0"}}), 0);
    EXPECT_EQ(verdict("POST", {{"content-length", "1000"}}), 0);
    EXPECT_EQ(verdict("GET", {{"range", "bytes=0-10"}}), 0);
}

TEST(Guard, RefusesWhatHidesTheEndOfTheBody) {
    EXPECT_EQ(verdict("POST", {{"transfer-encoding", "chunked"}}), 411);
    EXPECT_EQ(verdict("POST", {{"transfer-encoding", "chunked"}, {"content-length", "5"}}), 411);
    EXPECT_EQ(verdict("GET", {{"transfer-encoding", "identity"}}), 411);
    EXPECT_EQ(verdict("POST", {{"content-length", "5"}, {"content-length", "5"}}), 400);
    EXPECT_EQ(verdict("GET", {{"content-length", "5"}}), 400);
    for (const char* length :
         {"", "abc", "-1", "+5", "0x5", "5 ", "5,5", "5.0", "99999999999999999999999999"}) {
        EXPECT_EQ(verdict("POST", {{"content-length", length}}), 400) << length;
    }
}

TEST(Guard, RefusesWhatCostsTooMuch) {
    EXPECT_EQ(verdict("POST", {{"content-length", "1001"}}), 413);
    EXPECT_EQ(verdict("POST", {{"content-length", "5"}, {"content-encoding", "gzip"}}), 415);
    EXPECT_EQ(verdict("GET", {{"range", "bytes=0-1,2-3"}}), 416);
    EXPECT_EQ(verdict("GET", {{"range", "bytes=0-1"}, {"range", "bytes=2-3"}}), 416);
    EXPECT_EQ(verdict("GET", std::vector<NameValue>(kMaxHeaders, {"x", "y"})), 0);
    EXPECT_EQ(verdict("GET", {}, "/" + std::string(kMaxPathBytes - 1, 'a')), 0);
    EXPECT_EQ(verdict("GET", {}, "/" + std::string(kMaxPathBytes, 'a')), 414);
    EXPECT_EQ(verdict("GET", {{"host", "a"}, {"host", "b"}}), 400);
}

TEST(Guard, RefusesExpectationsItDoesNotKnow) {
    for (const char* known :
         {"", "100-continue", "100-Continue", " ,100-CONTINUE,", "100-continue, 100-continue"})
        EXPECT_EQ(verdict("POST", {{"expect", known}, {"content-length", "5"}}), 0) << known;
    for (const char* unknown : {"200-ok", "100", "100-continue;q=1", "100-continue=1",
                                "100-continue, eggs", "\"100-continue\""})
        EXPECT_EQ(verdict("POST", {{"expect", unknown}, {"content-length", "5"}}), 417) << unknown;
    EXPECT_EQ(verdict("GET", {{"expect", "100-continue"}, {"expect", "eggs"}}), 417);
}

TEST(Guard, KnowsWhoWaitsBeforeItSends) {
    const auto waits = [](std::vector<NameValue> headers) {
        Request request;
        request.headers = std::move(headers);
        return awaits_invitation(request);
    };
    EXPECT_TRUE(waits({{"expect", "100-continue"}, {"content-length", "5"}}));
    EXPECT_TRUE(waits({{"expect", "100-Continue"}, {"content-length", "5"}}));
    EXPECT_FALSE(waits({{"content-length", "5"}}));
    EXPECT_FALSE(waits({{"expect", "100-continue"}})) << "it has nothing to send";
    EXPECT_FALSE(waits({{"expect", "100-continue"}, {"content-length", "0"}}));
}

TEST(Guard, NamesTheLimit) {
    Request request;
    request.method = "POST";
    request.path = "/";
    request.headers = {{"content-length", "300000000"}};
    const auto problem = check_request_head(request, Limits{});
    ASSERT_TRUE(problem);
    EXPECT_NE(problem->detail.find("max_body_bytes"), std::string::npos);
    EXPECT_NE(problem->detail.find("268435456"), std::string::npos);
}

}  // namespace
}  // namespace tinsmith::server
