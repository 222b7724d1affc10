// SPDX-License-Identifier: Apache-2.0
#include "server/router.hpp"

#include <array>
#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

#include "server/log.hpp"
#include "server/reply.hpp"

namespace tinsmith::server {
namespace {

constexpr std::array<std::string_view, 2> kKnown{"limit", "cursor"};

Handler says(const std::string& word) {
    return [word](const Request&, const PathArguments& arguments) {
        std::string text = word;
        for (const std::string& argument : arguments)
            text += ":" + argument;
        return ok("text/plain", text);
    };
}

Router router() {
    return Router({
        {"GET", "/", {}, says("root")},
        {"GET", "/things", kKnown, says("list")},
        {"POST", "/things", {}, says("make")},
        {"GET", "/things/{id}", {}, says("one")},
        {"GET", "/things/{id}/parts/{part}", {}, says("part")},
        {"GET",
         "/throws",
         {},
         [](const Request&, const PathArguments&) -> Response {
             throw std::runtime_error("the secret");
         }},
        {"GET",
         "/full",
         {},
         [](const Request&, const PathArguments&) -> Response { throw std::bad_alloc(); }},
    });
}

Response ask(const std::string& method, const std::string& path,
             std::vector<NameValue> query = {}) {
    Request request;
    request.method = method;
    request.path = path;
    request.query = std::move(query);
    request.id = "the-id";
    return router().handle(request);
}

std::string header(const Response& response, const std::string& name) {
    for (const auto& [key, value] : response.headers) {
        if (key == name) return value;
    }
    return "";
}

TEST(Router, FindsHandlersAndTheirArguments) {
    EXPECT_EQ(ask("GET", "/").body, "root");
    EXPECT_EQ(ask("GET", "/things").body, "list");
    EXPECT_EQ(ask("POST", "/things").body, "make");
    EXPECT_EQ(ask("GET", "/things/7").body, "one:7");
    EXPECT_EQ(ask("GET", "/things/a%2Fb%20c/parts/x").body, "part:a/b c:x");
}

TEST(Router, RefusesByTheHeadWhatNoHandlerAnswers) {
    const auto refusal = [](const std::string& method, const std::string& path,
                            std::vector<NameValue> query = {}) {
        Request head;
        head.method = method;
        head.path = path;
        head.query = std::move(query);
        const auto refused = router().refusal_of(head);
        return refused ? refused->status : 0;
    };
    EXPECT_EQ(refusal("POST", "/things"), 0);
    EXPECT_EQ(refusal("POST", "/nope"), 404);
    EXPECT_EQ(refusal("PUT", "/things"), 405);
    EXPECT_EQ(refusal("POST", "/things", {{"colour", "red"}}), 400);
    EXPECT_EQ(refusal("POST", "/throws"), 405) << "and nobody asked the handler";
}

TEST(Router, AnswersHeadAsGet) {
    EXPECT_EQ(ask("HEAD", "/things/7").body, "one:7");
}

TEST(Router, RefusesUnknownPaths) {
    for (const char* path : {"/thing", "/things/", "/things//parts/x", "/things/7/parts", "//",
                             "/things/7/parts/x/y", "/THINGS", "/%zz"}) {
        EXPECT_EQ(ask("GET", path).status, 404) << path;
        EXPECT_EQ(ask("BREW", path).status, 404) << path;
    }
}

TEST(Router, NamesTheMethodsOfAPath) {
    const Response refused = ask("DELETE", "/things");
    EXPECT_EQ(refused.status, 405);
    EXPECT_EQ(header(refused, "Allow"), "OPTIONS, GET, HEAD, POST");
    const Response options = ask("OPTIONS", "/things");
    EXPECT_EQ(options.status, 200);
    EXPECT_EQ(options.body, "");
    EXPECT_EQ(header(options, "Allow"), "OPTIONS, GET, HEAD, POST");
    EXPECT_EQ(ask("HEAD", "/nothing").status, 404);
}

TEST(Router, RefusesQueriesByName) {
    EXPECT_EQ(ask("GET", "/things", {{"limit", "1"}, {"cursor", "x"}}).status, 200);
    const Response unknown = ask("GET", "/things", {{"limit", "1"}, {"colour", "red"}});
    EXPECT_EQ(unknown.status, 400);
    EXPECT_NE(unknown.body.find("colour"), std::string::npos);
    EXPECT_NE(unknown.body.find("limit, cursor"), std::string::npos);
    EXPECT_EQ(ask("GET", "/things", {{"limit", "1"}, {"limit", "2"}}).status, 400);
    EXPECT_EQ(ask("POST", "/things", {{"limit", "1"}}).status, 400);
}

TEST(Router, GivesEveryAnswerTheRequestId) {
    set_log_level(LogLevel::Off);
    for (const char* path : {"/", "/nothing", "/throws", "/full"}) {
        EXPECT_EQ(header(ask("GET", path), "X-Request-Id"), "the-id") << path;
    }
}

TEST(Router, TellsNothingOfAnException) {
    set_log_level(LogLevel::Off);
    const Response response = ask("GET", "/throws");
    EXPECT_EQ(response.status, 500);
    EXPECT_EQ(response.body.find("secret"), std::string::npos);
    EXPECT_EQ(ask("GET", "/full").status, 507);
    set_log_level(LogLevel::Info);
}

}  // namespace
}  // namespace tinsmith::server
