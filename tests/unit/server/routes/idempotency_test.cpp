// SPDX-License-Identifier: Apache-2.0
// Retries by Idempotency-Key, as a client meets them.
#include "server/routes/idempotency.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include "server/log.hpp"
#include "server/reply.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

class Retries : public Handlers {
  protected:
    static NameValue key(const std::string& text) { return {"idempotency-key", text}; }
};

TEST_F(Retries, DoNotApplyTwice) {
    const std::string session = make_session();
    const std::string tag = header(ask("GET", session), "ETag");
    const std::vector<NameValue> headers{key("k1"), {"if-match", tag}};
    const Response first = post(session + "/polygons", kParcel, headers);
    ASSERT_EQ(first.status, 200) << first.body;
    EXPECT_EQ(header(first, "Idempotency-Replayed"), "");
    const Response again = post(session + "/polygons", kParcel, headers);
    EXPECT_EQ(again.status, 200) << "the key comes before the condition, which is stale by now";
    EXPECT_EQ(again.body, first.body);
    EXPECT_EQ(header(again, "ETag"), header(first, "ETag"));
    EXPECT_EQ(header(again, "Idempotency-Replayed"), "true");
    EXPECT_EQ(version_of(session), 2);
    EXPECT_EQ(post(session + "/polygons", kParcel, {key("\"k1\"")}).status, 200);
    EXPECT_EQ(version_of(session), 2) << "quoted or bare, the same key";
    EXPECT_EQ(post(session + "/polygons", kParcel, {key("k2")}).status, 200);
    EXPECT_EQ(version_of(session), 3);
}

TEST_F(Retries, AreRefusedWhereTheRequestIsAnother) {
    const std::string session = make_session();
    ASSERT_EQ(post(session + "/polygons", kParcel, {key("k")}).status, 200);
    const Response other = post(session + "/polygons", kParcel + std::string(" "), {key("k")});
    EXPECT_EQ(other.status, 422);
    EXPECT_EQ(told(other), "key-reused");
    EXPECT_EQ(told(post(session + "/polygons?snap=1", kParcel, {key("k")})), "key-reused");
    EXPECT_EQ(told(ask("POST", session + "/fork", {key("k")})), "key-reused");
    EXPECT_EQ(version_of(session), 2);
}

TEST_F(Retries, CoverSessionsAndForks) {
    const Response made = post("/v1/sessions", kSquare, {key("k")});
    ASSERT_EQ(made.status, 201);
    const Response again = post("/v1/sessions", kSquare, {key("k")});
    EXPECT_EQ(header(again, "Location"), header(made, "Location"));
    EXPECT_EQ(services.sessions.size(), 1U);
    const std::string fork = header(made, "Location") + "/fork";
    EXPECT_EQ(ask("POST", fork, {key("k")}).status, 201) << "a session's keys are its own";
    EXPECT_EQ(ask("POST", fork, {key("k")}).status, 201);
    EXPECT_EQ(services.sessions.size(), 2U);
    EXPECT_EQ(told(ask("POST", "/v1/sessions/none/fork", {key("k")})), "no-such-session");
}

TEST_F(Retries, AreJudgedAnewWhereNothingWasDone) {
    const std::string session = make_session();
    const std::string path = session + "/polygons";
    const std::string tag = header(ask("GET", session), "ETag");
    EXPECT_EQ(ask("POST", path, {key("a"), {"content-type", "text/csv"}}, kParcel).status, 415);
    EXPECT_EQ(post(path, kParcel, {key("a"), {"if-match", "\"x\""}}).status, 412);
    EXPECT_EQ(post(path, kParcel, {key("a"), {"if-match", tag}}).status, 200);
    const Response bad = post(path, "null", {key("b")});
    EXPECT_EQ(bad.status, 422);
    EXPECT_EQ(header(post(path, "null", {key("b")}), "Idempotency-Replayed"), "true");
}

TEST_F(Retries, GoAgainAfterAFailureOfTheServer) {
    set_log_level(LogLevel::Off);
    int calls = 0;
    const Handler fails_once =
        keyed(services, [&calls](const Request& request, const PathArguments&) -> Response {
            if (++calls == 1) throw std::bad_alloc();
            if (calls == 2) return refuse(request, api::ProblemType::Stopped, "no");
            return ok("text/plain", "fine");
        });
    const Router failing({{"POST", "/", {}, fails_once}});
    Request request;
    request.method = "POST";
    request.path = "/";
    request.headers = {key("k")};
    EXPECT_EQ(failing.handle(request).status, 507);
    EXPECT_EQ(failing.handle(request).status, 503);
    EXPECT_EQ(failing.handle(request).body, "fine");
    EXPECT_EQ(failing.handle(request).body, "fine");
    EXPECT_EQ(calls, 3);
    set_log_level(LogLevel::Info);
}

TEST_F(Retries, RefuseMalformedKeys) {
    const std::string long_key(256, 'k');
    for (const std::string& bad : {std::string(), std::string("\"\""), std::string("a b"),
                                   std::string("a,b"), std::string("\"a"), long_key}) {
        const Response refused = post("/v1/sessions", kSquare, {key(bad)});
        EXPECT_EQ(refused.status, 400) << bad;
    }
    EXPECT_EQ(post("/v1/sessions", kSquare, {key("a"), key("a")}).status, 400);
    EXPECT_EQ(services.sessions.size(), 0U);
}

TEST_F(Retries, EndWithTheSession) {
    const NameValue type{"content-type", "application/json"};
    ASSERT_EQ(ask("PUT", "/v1/sessions/s", {type}, kSquare).status, 201);
    ASSERT_EQ(post("/v1/sessions/s/polygons", kParcel, {key("k")}).status, 200);
    ASSERT_EQ(ask("DELETE", "/v1/sessions/s").status, 200);
    EXPECT_EQ(services.answers.size(), 0U);
    ASSERT_EQ(ask("PUT", "/v1/sessions/s", {type}, kSquare).status, 201);
    EXPECT_EQ(post("/v1/sessions/s/polygons", kParcel, {key("k")}).status, 200);
    EXPECT_EQ(version_of("/v1/sessions/s"), 2) << "another life, another request";
}

TEST_F(Retries, ApplyOnceHoweverManyRace) {
    const std::string session = make_session();
    constexpr int kThreads = 6;
    constexpr int kKeys = 15;
    std::atomic<int> fresh{0};
    std::atomic<int> replayed{0};
    std::vector<std::thread> clients;
    for (int i = 0; i < kThreads; ++i) {
        clients.emplace_back([&] {
            for (int k = 0; k < kKeys; ++k) {
                const std::vector<NameValue> headers{key("key-" + std::to_string(k))};
                for (;;) {
                    const Response answer = post(session + "/polygons", kParcel, headers);
                    if (answer.status == 409) {
                        EXPECT_EQ(told(answer), "key-in-use");
                        EXPECT_EQ(header(answer, "Retry-After"), "1");
                        std::this_thread::sleep_for(std::chrono::milliseconds(1));
                        continue;
                    }
                    EXPECT_EQ(answer.status, 200) << answer.body;
                    ++(header(answer, "Idempotency-Replayed") == "true" ? replayed : fresh);
                    break;
                }
            }
        });
    }
    for (std::thread& client : clients)
        client.join();
    EXPECT_EQ(fresh, kKeys);
    EXPECT_EQ(replayed, kKeys * (kThreads - 1));
    EXPECT_EQ(version_of(session), 1 + kKeys);
}

}  // namespace
}  // namespace tinsmith::server
