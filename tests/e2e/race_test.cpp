// SPDX-License-Identifier: Apache-2.0
// Many clients that change one session at the same time, each change sent twice: what comes of it
// is what the same changes make one after the other.
#include <map>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/e2e/program.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {
namespace {

using nlohmann::json;

constexpr int kClients = 3;
constexpr int kChangesOfEach = 10;
const std::string kJson = "Content-Type: application/json";

std::string grid() {
    std::string text = R"({"grid": {"origin": [0,0], "cell": [1,1], "columns": 12, "rows": 12,
                           "elevations": [0)";
    for (int i = 1; i < 144; ++i)
        text += "," + std::to_string(i % 5);
    return text + "]}}";
}

/// One change of a session.
struct Change {
    std::string method;
    std::string path;  ///< below the session's
    std::string body;
};

/// The i-th change that a client wishes for: mostly edits, some of which are taken back, made again
/// or taken out.
Change change_of(int client, int i) {
    switch (i % 5) {
        case 2:
            return {"POST", "/undo", ""};
        case 3:
            return {"POST", "/redo", ""};
        case 4:
            return {"DELETE", "/polygons/p" + std::to_string(1 + (i * 7 + client) % 9), ""};
        default:
            break;
    }
    const std::string x = std::to_string(1 + client * 3) + ".25";
    const std::string y = std::to_string(1 + i) + "." + std::to_string(1 + client);
    return {
        "POST", "/polygons",
        R"({"type": "LineString", "coordinates": [[)" + x + "," + y + "],[" + y + "," + x + "]]}"};
}

class Race : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        server = new ServerUnderTest();
        ASSERT_NE(server->port(), 0) << server->program().output();
    }
    static void TearDownTestSuite() {
        EXPECT_EQ(server->stop(), "");
        delete server;
        server = nullptr;
    }

    static Answer send(const std::string& session, const Change& change,
                       std::vector<std::string> headers = {}) {
        headers.push_back(kJson);
        return ask(server->port(), change.method, session + change.path, headers, change.body);
    }

    static std::string make_session() {
        const Answer made = ask(server->port(), "POST", "/v1/sessions", {kJson}, grid());
        EXPECT_EQ(made.status, 201) << made.body;
        return made.header("location");
    }

    static int version_of(const Answer& answer) {
        return json::parse(answer.body)["version"].get<int>();
    }

    /// Makes the change of the version that the client has just seen, however often another is
    /// first. The version it made; 0: there was nothing to be done.
    static int insist(const std::string& session, const Change& change, const std::string& key) {
        for (int attempt = 0;; ++attempt) {
            const Answer seen = ask(server->port(), "GET", session);
            const std::vector<std::string> headers{
                "If-Match: " + seen.header("etag"),
                "Idempotency-Key: " + key + "-" + std::to_string(attempt)};
            const Answer answer = send(session, change, headers);
            if (answer.status == 412) continue;
            if (change.method == "POST") expect_same(send(session, change, headers), answer);
            if (answer.status == 404 || answer.status == 409) return 0;
            EXPECT_EQ(answer.status, 200) << answer.body;
            EXPECT_EQ(version_of(answer), version_of(seen) + 1);
            return version_of(answer);
        }
    }

    static void expect_same(const Answer& retry, const Answer& first) {
        EXPECT_EQ(retry.status, first.status);
        EXPECT_EQ(retry.body, first.body);
        EXPECT_EQ(retry.header("idempotency-replayed"), "true");
    }

    static inline ServerUnderTest* server = nullptr;
};

TEST_F(Race, EveryVersionIsMadeOnceAndRetriesNeverApplyTwice) {
    const std::string session = make_session();
    std::mutex mutex;
    std::map<int, Change> made;
    std::vector<std::thread> clients;
    for (int client = 0; client < kClients; ++client) {
        clients.emplace_back([&, client] {
            for (int i = 0; i < kChangesOfEach; ++i) {
                const Change change = change_of(client, i);
                const int version =
                    insist(session, change, std::to_string(client) + "-" + std::to_string(i));
                if (version == 0) continue;
                const std::lock_guard lock(mutex);
                EXPECT_TRUE(made.try_emplace(version, change).second) << version << " twice";
            }
        });
    }
    for (std::thread& client : clients)
        client.join();

    const int last = version_of(ask(server->port(), "GET", session));
    EXPECT_EQ(last, 1 + static_cast<int>(made.size())) << "each version has one change";
    EXPECT_GE(made.size(), static_cast<std::size_t>(kClients * kChangesOfEach * 2 / 5));
    const std::string alone = make_session();
    for (const auto& [version, change] : made)
        EXPECT_EQ(version_of(send(alone, change)), version) << change.method << change.path;
    EXPECT_EQ(ask(server->port(), "GET", session + "/mesh.json").body,
              ask(server->port(), "GET", alone + "/mesh.json").body);
}

}  // namespace
}  // namespace tinsmith::e2e
