// SPDX-License-Identifier: Apache-2.0
#include "server/answer_finish.hpp"

#include <gtest/gtest.h>

#include "server/reply.hpp"

namespace tinsmith::server {
namespace {

std::string header(const Response& response, const std::string& name) {
    for (const auto& [key, value] : response.headers) {
        if (key == name) return value;
    }
    return "";
}

Request asking(std::vector<NameValue> headers, const std::string& method = "GET") {
    Request request;
    request.method = method;
    request.path = "/";
    request.headers = std::move(headers);
    return request;
}

Response finished(const Request& request, Response response, const Policy& policy = {}) {
    finish_answer(policy, request, response);
    return response;
}

const std::string kLong(5000, ' ');

TEST(AnswerFinish, CompressesLongJson) {
    const Request request = asking({{"accept-encoding", "gzip"}});
    for (const char* type : {"application/json", "application/geo+json", "application/problem+json",
                             "Application/JSON; charset=utf-8", "text/javascript; charset=utf-8",
                             "text/css; charset=utf-8", "text/html; charset=utf-8"}) {
        const Response coded = finished(request, ok(type, kLong).with("ETag", "\"a-1\""));
        EXPECT_EQ(header(coded, "Content-Encoding"), "gzip") << type;
        EXPECT_LT(coded.body.size(), 200U);
        EXPECT_EQ(header(coded, "ETag"), "\"a-1-gzip\"");
        EXPECT_EQ(header(coded, "Vary"), "Accept-Encoding");
    }
    EXPECT_EQ(finished(asking({{"accept-encoding", "gzip"}}, "HEAD"), ok(kJson, kLong)).body.size(),
              finished(request, ok(kJson, kLong)).body.size());
}

TEST(AnswerFinish, LeavesTheRestAlone) {
    const Request request = asking({{"accept-encoding", "gzip"}});
    const Response glb = finished(request, ok(kGlb, kLong).with("Vary", "Accept"));
    EXPECT_EQ(glb.body, kLong);
    EXPECT_EQ(header(glb, "Content-Encoding"), "");
    EXPECT_EQ(header(glb, "Vary"), "Accept");
    EXPECT_EQ(finished(request, ok(kJson, "{}")).body, "{}");
    const Response plain = finished(asking({}), ok(kJson, kLong).with("Vary", "Accept"));
    EXPECT_EQ(plain.body, kLong);
    EXPECT_EQ(header(plain, "Vary"), "Accept, Accept-Encoding") << "others get it coded";
    const Response edit = finished(asking({{"accept-encoding", "gzip"}}, "POST"),
                                   ok(kJson, kLong).with("ETag", "\"a-2\""));
    EXPECT_EQ(header(edit, "Content-Encoding"), "gzip");
    EXPECT_EQ(header(edit, "ETag"), "\"a-2\"") << "the session's, not this answer's";
}

TEST(AnswerFinish, PassesTheTraceOn) {
    Request request = asking({});
    EXPECT_EQ(header(finished(request, ok(kJson, "{}")), "traceparent"), "");
    const std::string text = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01";
    request.trace = parse_traceparent(text);
    EXPECT_EQ(header(finished(request, ok(kJson, "{}")), "traceparent"), text);
}

const Policy kTwoOrigins{false, {"https://a.example", "http://localhost:3000"}};

TEST(Cors, TellsAllowedOriginsWhatTheyMayRead) {
    for (const std::string& origin : kTwoOrigins.cors_origins) {
        const Response told = finished(asking({{"origin", origin}}), ok(kGlb, "x"), kTwoOrigins);
        EXPECT_EQ(header(told, "Access-Control-Allow-Origin"), origin);
        EXPECT_EQ(header(told, "Vary"), "Origin");
        const std::string exposed = header(told, "Access-Control-Expose-Headers");
        EXPECT_TRUE(
            exposed.starts_with("ETag, Location, Link, Idempotency-Replayed, X-Request-Id, "
                                "traceparent, Retry-After"));
        EXPECT_NE(exposed.find("Tinsmith-Origin"), std::string::npos);
        EXPECT_EQ(header(told, "Access-Control-Allow-Credentials"), "");
    }
}

TEST(Cors, TellsOthersNothing) {
    for (const char* origin : {"https://b.example", "https://a.example.evil", "null", "*",
                               "http://a.example", "https://a.example/", "HTTPS://A.EXAMPLE"}) {
        const Response told = finished(asking({{"origin", origin}}), ok(kGlb, "x"), kTwoOrigins);
        for (const auto& [name, value] : told.headers)
            EXPECT_FALSE(name.starts_with("Access-Control")) << origin << " " << name;
        EXPECT_EQ(header(told, "Vary"), "Origin") << "a cache must not give it to the others";
    }
    EXPECT_TRUE(finished(asking({{"origin", "https://a.example"}}), ok(kGlb, "x")).headers.empty());
}

TEST(Cors, LetsEveryoneInOnlyWhenTold) {
    const Policy all{false, {"*"}};
    const Response told = finished(asking({{"origin", "https://b.example"}}), ok(kGlb, "x"), all);
    EXPECT_EQ(header(told, "Access-Control-Allow-Origin"), "*");
    EXPECT_EQ(header(told, "Vary"), "");
    EXPECT_TRUE(finished(asking({}), ok(kGlb, "x"), all).headers.empty());
}

TEST(Cors, AnswersPreflights) {
    const auto preflight = [](const std::string& origin) {
        const Request request = asking(
            {{"origin", origin},
             {"access-control-request-method", "POST"},
             {"access-control-request-headers", "Content-Type, if-match, idempotency-key,x-evil"}},
            "OPTIONS");
        return finished(request, ok({}, {}).with("Allow", "OPTIONS, GET, HEAD, POST"), kTwoOrigins);
    };
    const Response fine = preflight("https://a.example");
    EXPECT_EQ(header(fine, "Access-Control-Allow-Origin"), "https://a.example");
    EXPECT_EQ(header(fine, "Access-Control-Allow-Methods"), "OPTIONS, GET, HEAD, POST");
    EXPECT_EQ(header(fine, "Access-Control-Allow-Headers"),
              "content-type, if-match, idempotency-key");
    EXPECT_EQ(header(fine, "Access-Control-Max-Age"), "600");
    EXPECT_EQ(header(fine, "Vary"), "Origin, Access-Control-Request-Headers");
    EXPECT_EQ(header(preflight("https://b.example"), "Access-Control-Allow-Methods"), "");
}

}  // namespace
}  // namespace tinsmith::server
