// SPDX-License-Identifier: Apache-2.0
// HTTP's manners where the wire matters: conditions, retries, HEAD, coding, other origins, traces.
#include <atomic>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/e2e/program.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {
namespace {

using nlohmann::json;

const std::string kJson = "Content-Type: application/json";
const std::string kGzip = "Accept-Encoding: gzip, br";
const std::string kPage = "Origin: https://maps.example";
const std::string kTrace = "0af7651916cd43dd8448eb211c80319c";
const std::string kParcel =
    R"({"type": "Polygon", "coordinates": [[[2,2],[5,2],[5,5],[2,5],[2,2]]]})";

std::string grid() {
    std::string text = R"({"grid": {"origin": [0,0], "cell": [1,1], "columns": 30, "rows": 30,
                           "elevations": [0)";
    for (int i = 1; i < 900; ++i)
        text += "," + std::to_string(i % 7);
    return text + "]}}";
}

/// One server for all tests, that knows one other origin; at the end its log must be clean.
class Manners : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        server = new ServerUnderTest({"--cors-origin", "https://maps.example"});
        ASSERT_NE(server->port(), 0) << server->program().output();
    }
    static void TearDownTestSuite() {
        EXPECT_EQ(server->stop(), "");
        delete server;
        server = nullptr;
    }

    static Answer send(const std::string& method, const std::string& target,
                       const std::vector<std::string>& headers = {}, const std::string& body = {}) {
        return ask(server->port(), method, target, headers, body);
    }

    static std::string make_session() {
        const Answer made = send("POST", "/v1/sessions", {kJson}, grid());
        EXPECT_EQ(made.status, 201) << made.body;
        return made.header("location");
    }

    static inline ServerUnderTest* server = nullptr;
};

TEST_F(Manners, SendNothingWithNotModifiedAndGoOn) {
    const std::string mesh = make_session() + "/mesh.json";
    const Answer first = send("GET", mesh);
    Connection connection(server->port());
    for (int i = 0; i < 3; ++i) {
        connection.send(request_text("GET", mesh, {"If-None-Match: " + first.header("etag")}));
        const Answer same = connection.read(true);
        EXPECT_EQ(same.status, 304);
        EXPECT_EQ(same.header("content-length"), "") << "not that of an empty body";
        EXPECT_EQ(same.header("content-type"), "");
        EXPECT_EQ(same.header("etag"), first.header("etag"));
    }
    connection.send(request_text("GET", mesh));
    EXPECT_EQ(connection.read().body, first.body);
}

TEST_F(Manners, CompressJsonAndNotDraco) {
    const std::string session = make_session();
    const Answer plain = send("GET", session + "/mesh.json");
    const Answer coded = send("GET", session + "/mesh.json", {kGzip});
    EXPECT_EQ(plain.header("content-encoding"), "");
    EXPECT_EQ(coded.header("content-encoding"), "gzip");
    EXPECT_TRUE(coded.body.starts_with("\x1f\x8b"));
    EXPECT_LT(coded.body.size(), plain.body.size() / 3);
    EXPECT_NE(coded.header("etag"), plain.header("etag"));
    EXPECT_EQ(plain.header("vary"), "Accept-Encoding, Origin");
    EXPECT_EQ(send("GET", session + "/mesh.json", {"Accept-Encoding: gzip;q=0"}).body, plain.body);
    const Answer glb = send("GET", session + "/mesh.glb", {kGzip});
    EXPECT_EQ(glb.header("content-encoding"), "");
    EXPECT_TRUE(glb.body.starts_with("glTF"));
    const Answer head = send("HEAD", session + "/mesh.json", {kGzip});
    EXPECT_EQ(head.status, 200);
    EXPECT_EQ(head.header("content-length"), std::to_string(coded.body.size()));
    EXPECT_EQ(send("HEAD", session + "/mesh.glb").header("content-length"),
              std::to_string(glb.body.size()));
}

TEST_F(Manners, AnswerPreflightsAndLetPagesReadRefusals) {
    const std::string session = make_session();
    const Answer preflight =
        send("OPTIONS", session + "/polygons",
             {kPage, "Access-Control-Request-Method: POST",
              "Access-Control-Request-Headers: content-type,if-match,idempotency-key"});
    EXPECT_EQ(preflight.status, 200);
    EXPECT_EQ(preflight.header("allow"), "OPTIONS, POST, GET, HEAD");
    EXPECT_EQ(preflight.header("access-control-allow-origin"), "https://maps.example");
    EXPECT_EQ(preflight.header("access-control-allow-methods"), "OPTIONS, POST, GET, HEAD");
    EXPECT_EQ(preflight.header("access-control-allow-headers"),
              "content-type, if-match, idempotency-key");
    const Answer refused = send("GET", session + "/mesh.json",
                                {kPage, "Content-Length: 5"});  // by the guard, before any route
    EXPECT_EQ(refused.status, 400);
    EXPECT_EQ(refused.header("access-control-allow-origin"), "https://maps.example");
    EXPECT_NE(refused.header("access-control-expose-headers").find("ETag"), std::string::npos);
    const Answer other = send("GET", session, {"Origin: https://evil.example"});
    EXPECT_EQ(other.status, 200);
    for (const auto& [name, value] : other.headers)
        EXPECT_FALSE(name.starts_with("access-control")) << name;
    EXPECT_EQ(send("PUT", session + "/fork", {kJson}).header("allow"), "OPTIONS, POST");
}

TEST_F(Manners, PassTracesOnAndLogThem) {
    const Answer answer =
        send("GET", "/v1/limits", {"traceparent: 00-" + kTrace + "-b7ad6b7169203331-01"});
    const std::string passed = answer.header("traceparent");
    EXPECT_TRUE(passed.starts_with("00-" + kTrace + "-")) << passed;
    EXPECT_EQ(passed.find("b7ad6b7169203331"), std::string::npos) << "the span is our own";
    EXPECT_NE(server->program().output().find("\"trace\":\"" + kTrace + "\",\"span\":\""),
              std::string::npos);
    const Answer bad = send("GET", "/v1/limits", {"traceparent: 00-" + kTrace + "-bad"});
    EXPECT_EQ(bad.header("traceparent"), "");
    EXPECT_EQ(server->program().output().find("-bad"), std::string::npos);
}

TEST_F(Manners, ApplyARetryOnceThoughManyRace) {
    const std::string session = make_session();
    std::atomic<int> fresh{0};
    std::vector<std::thread> clients;
    for (int i = 0; i < 4; ++i) {
        clients.emplace_back([&] {
            for (int key = 0; key < 5;) {
                const Answer answer = send(
                    "POST", session + "/polygons",
                    {kJson, "Idempotency-Key: \"retry-" + std::to_string(key) + "\""}, kParcel);
                if (answer.status == 409) {
                    EXPECT_EQ(answer.header("retry-after"), "1");
                    continue;
                }
                EXPECT_EQ(answer.status, 200) << answer.body;
                if (answer.header("idempotency-replayed") != "true") ++fresh;
                ++key;
            }
        });
    }
    for (std::thread& client : clients)
        client.join();
    EXPECT_EQ(fresh, 5);
    EXPECT_EQ(json::parse(send("GET", session).body)["version"], 6);
}

TEST_F(Manners, KeepClientsWithIfMatchApart) {
    const std::string session = make_session();
    std::vector<std::thread> clients;
    for (int i = 0; i < 2; ++i) {
        clients.emplace_back([&] {
            for (int done = 0; done < 10;) {
                const Answer seen = send("GET", session);
                const Answer answer = send("POST", session + "/polygons",
                                           {kJson, "If-Match: " + seen.header("etag")}, kParcel);
                if (answer.status == 412) continue;
                ASSERT_EQ(answer.status, 200) << answer.body;
                EXPECT_EQ(json::parse(answer.body)["version"].get<int>(),
                          json::parse(seen.body)["version"].get<int>() + 1);
                ++done;
            }
        });
    }
    for (std::thread& client : clients)
        client.join();
    EXPECT_EQ(json::parse(send("GET", session).body)["version"], 21);
}

TEST_F(Manners, LeadFromPageToPage) {
    make_session();
    make_session();
    const Answer first = send("GET", "/v1/sessions?limit=1");
    const std::string link = first.header("link");
    ASSERT_TRUE(link.starts_with("</v1/sessions?limit=1&cursor=")) << link;
    EXPECT_EQ(send("GET", link.substr(1, link.find('>') - 1)).status, 200);
    EXPECT_EQ(send("GET", "/v1/sessions?cursor=x").status, 400);
}

}  // namespace
}  // namespace tinsmith::e2e
