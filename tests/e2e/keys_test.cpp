// SPDX-License-Identifier: Apache-2.0
// API keys with the real binary: who may start it, who may ask it, and who sees what, over
// restarts.
#include <cctype>
#include <csignal>
#include <filesystem>
#include <functional>
#include <set>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/e2e/program.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {
namespace {

using nlohmann::json;

const std::string kJson = "Content-Type: application/json";
const std::string kSquare =
    R"({"mesh": {"vertices": [[0,0,0],[10,0,1],[10,10,2],[0,10,3]],
                 "triangles": [[0,1,2],[0,2,3]]}})";
const std::string kParcel =
    R"({"type": "Polygon", "coordinates": [[[1,2],[5,2],[5,7],[1,7],[1,2]]]})";

std::string bearer(const std::string& key) {
    return "Authorization: Bearer " + key;
}

/// What `tinsmith` says when it has ended, and its exit code in front.
std::string run(const std::vector<std::string>& arguments) {
    const ScratchDirectory scratch;
    Program program(arguments, scratch.file("out"));
    const auto code = program.wait();
    return (code ? std::to_string(*code) : "still runs") + " " + program.output();
}

/// The key in an output; empty: there is none.
std::string key_in(const std::string& output) {
    const std::size_t begin = output.find("tin_");
    return begin == output.npos ? "" : output.substr(begin, 68);
}

bool becomes_true(const std::function<bool()>& is_it) {
    for (int i = 0; i < 500; ++i) {
        if (is_it()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
}

class KeyedService : public ::testing::Test {
  protected:
    std::string data() const { return scratch_.file("data"); }
    std::string add(const std::string& name, std::vector<std::string> more = {}) const {
        std::filesystem::create_directory(data());
        more.insert(more.begin(), {"key", "add", name, "--data", data()});
        const std::string said = run(more);
        EXPECT_EQ(said.substr(0, 2), "0 ") << said;
        EXPECT_EQ(key_in(said).size(), 68U) << said;
        return key_in(said);
    }

    ScratchDirectory scratch_;
};

TEST_F(KeyedService, KeysAreMadeListedRenewedAndRemoved) {
    const std::string alice = add("alice", {"--max-sessions", "3", "--max-memory-bytes", "1GB"});
    const std::string file = data() + "/keys";
    struct stat status {};
    ASSERT_EQ(::stat(file.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0600U);
    EXPECT_EQ(content_of(file).find(alice.substr(4)), std::string::npos) << "hashed at rest";
    const std::string list = run({"key", "list", "--keys", file});
    EXPECT_EQ(list.substr(0, 8), "0 alice\t") << list;
    EXPECT_NE(list.find("\tmax_sessions=3\tmax_memory_bytes=1073741824\n"), std::string::npos);
    EXPECT_NE(run({"key", "add", "alice", "--keys", file}).find("already"), std::string::npos);
    for (const char* bad : {"../x", "", "a b", "-x", "\n{\"event\":\"stopped\"}"})
        EXPECT_NE(run({"key", "add", "--keys", file, "--", bad}).substr(0, 2), "0 ") << bad;
    const std::string renewed = run({"key", "renew", "alice", "--keys", file});
    EXPECT_EQ(renewed.substr(0, 2), "0 ") << renewed;
    EXPECT_NE(key_in(renewed), alice);
    const std::string id = list.substr(8, 16);
    EXPECT_NE(run({"key", "list", "--data", data()}).find(id), std::string::npos) << "the same id";
    EXPECT_NE(run({"key", "remove", "alice", "--keys", file}).find(id), std::string::npos);
    EXPECT_EQ(run({"key", "list", "--keys", file}), "0 ");
    EXPECT_EQ(run({"key", "remove", "alice", "--keys", file}).substr(0, 2), "1 ");
    EXPECT_EQ(run({"key", "list"}).substr(0, 2), "2 ") << "which file?";
    EXPECT_EQ(run({"key"}).substr(0, 2), "2 ");
}

TEST_F(KeyedService, DoesNotStartOpenBeyondThisMachine) {
    for (const char* host : {"0.0.0.0", "::", "localhost.localdomain", "127.0.0.1.example.org"}) {
        const std::string refused = run({"serve", "--port", "0", "--host", host});
        EXPECT_EQ(refused.substr(0, 2), "1 ") << host << refused;
        EXPECT_NE(refused.find("tinsmith key add"), std::string::npos) << refused;
        EXPECT_NE(refused.find("--insecure"), std::string::npos);
    }
    std::filesystem::create_directory(data());
    write_content(data() + "/keys", "# none\n");
    EXPECT_EQ(run({"serve", "--port", "0", "--host", "0.0.0.0", "--data", data()}).substr(0, 2),
              "1 ")
        << "a file without keys is none";
    add("alice");
    ServerUnderTest server({"--host", "0.0.0.0", "--data", data()});
    ASSERT_NE(server.port(), 0) << server.program().output();
    EXPECT_EQ(ask(server.port(), "GET", "/v1/sessions").status, 401);
    EXPECT_EQ(server.stop(), "") << "with keys there is nothing to warn of";
}

TEST_F(KeyedService, DoesNotStartWithAFileThatIsWrong) {
    const std::string file = scratch_.file("keys");
    EXPECT_EQ(run({"serve", "--port", "0", "--keys", file}).substr(0, 2), "1 ")
        << "a file that was named has to be there";
    write_content(file, "# keys\nalice 01 nonsense never\nbob\n");
    const std::string refused = run({"serve", "--port", "0", "--keys", file});
    EXPECT_EQ(refused.substr(0, 2), "1 ") << refused;
    EXPECT_NE(refused.find("keys:2: "), std::string::npos) << refused;
    EXPECT_NE(refused.find("keys:3: "), std::string::npos) << refused;
}

TEST_F(KeyedService, MakesAFirstKeyOnce) {
    std::string key;
    {
        ServerUnderTest server({"--host", "0.0.0.0", "--data", data(), "--first-key"});
        ASSERT_NE(server.port(), 0) << server.program().output();
        const std::string output = server.program().output();
        const std::size_t line = output.find("\nTINSMITH_KEY=tin_");
        ASSERT_NE(line, output.npos) << output;
        key = key_in(output);
        EXPECT_EQ(output.find(key, output.find(key) + 1), output.npos) << "once, and in no event";
        EXPECT_EQ(ask(server.port(), "GET", "/v1/sessions").status, 401);
        EXPECT_EQ(ask(server.port(), "GET", "/v1/sessions", {bearer(key)}).status, 200);
    }
    ServerUnderTest again({"--host", "0.0.0.0", "--data", data(), "--first-key"});
    ASSERT_NE(again.port(), 0) << again.program().output();
    EXPECT_EQ(key_in(again.program().output()), "");
    EXPECT_EQ(ask(again.port(), "GET", "/v1/sessions", {bearer(key)}).status, 200);
    EXPECT_EQ(again.stop(), "");
    EXPECT_EQ(run({"serve", "--port", "0", "--first-key"}).substr(0, 2), "1 ")
        << "there is nowhere to keep it";
}

/// Every operation that the description has, so that a new one cannot be forgotten.
TEST_F(KeyedService, KeepsSessionsToTheirKeys) {
    const std::string alice = add("alice"), bob = add("bob");
    ServerUnderTest server({"--data", data()});
    ASSERT_NE(server.port(), 0) << server.program().output();
    const auto as = [&](const std::string& key, const std::string& method,
                        const std::string& target, const std::string& body = {}) {
        std::vector<std::string> headers{bearer(key), "X-Request-Id: one"};
        if (!body.empty()) headers.push_back(kJson);
        return ask(server.port(), method, target, headers, body);
    };
    ASSERT_EQ(as(alice, "PUT", "/v1/sessions/hers", kSquare).status, 201);
    ASSERT_EQ(as(alice, "POST", "/v1/sessions/hers/polygons", kParcel).status, 200);
    const std::string tag = as(alice, "GET", "/v1/sessions/hers").header("etag");
    const json document = json::parse(ask(server.port(), "GET", "/openapi.json").body);
    std::size_t walked = 0;
    for (const auto& [path, item] : document["paths"].items()) {
        for (auto method_and_operation : item.items()) {
            std::string method = method_and_operation.key();
            for (char& c : method)
                c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
            const auto filled = [&, &pattern = path](const std::string& id) {
                std::string target = pattern;
                for (const auto& [name, value] : {std::pair<std::string, std::string>{"{id}", id},
                                                  {"{pid}", "p1"},
                                                  {"{version}", "2"},
                                                  {"{file}", "page.css"}}) {
                    const std::size_t at = target.find(name);
                    if (at != target.npos) target.replace(at, name.size(), value);
                }
                return target;
            };
            const bool is_kept = path.starts_with("/v1/") || path == "/metrics";
            const std::string title = method + " " + path;
            EXPECT_EQ(ask(server.port(), method, filled("hers")).status == 401, is_kept) << title;
            EXPECT_EQ(method_and_operation.value().contains("security"), is_kept) << title;
            if (!path.starts_with("/v1/sessions/{id}")) continue;
            ++walked;
            const bool has_body = method == "POST" || method == "PUT";
            Answer foreign = as(bob, method, filled("hers"), has_body ? kSquare : "");
            if (title == "PUT /v1/sessions/{id}") {
                EXPECT_EQ(foreign.status, 409);
                continue;
            }
            const Answer none = as(bob, method, filled("none"), has_body ? kSquare : "");
            EXPECT_EQ(foreign.status, 404) << title << foreign.body;
            for (std::size_t at; (at = foreign.body.find("hers")) != std::string::npos;)
                foreign.body.replace(at, 4, "none");
            EXPECT_EQ(foreign.body, none.body) << title;
        }
    }
    EXPECT_GE(walked, 28U);
    EXPECT_EQ(json::parse(as(bob, "GET", "/v1/sessions").body)["sessions"].size(), 0U);
    EXPECT_EQ(as(alice, "GET", "/v1/sessions/hers").header("etag"), tag);
    const std::string log = server.program().output();
    EXPECT_NE(log.find("\"key\":\"alice\""), log.npos);
    EXPECT_EQ(key_in(log), "") << "the name of a key is told, never the key";
    EXPECT_EQ(server.stop(), "");
}

TEST_F(KeyedService, KnowsAfterARestartWhoseASessionIs) {
    // Made while nobody had to show a key.
    {
        ServerUnderTest server({"--data", data()});
        ASSERT_NE(server.port(), 0) << server.program().output();
        EXPECT_EQ(ask(server.port(), "PUT", "/v1/sessions/old", {kJson}, kSquare).status, 201);
        EXPECT_EQ(server.stop(), "");
    }
    const std::string alice = add("alice"), bob = add("bob");
    {
        ServerUnderTest server({"--data", data()});
        ASSERT_NE(server.port(), 0) << server.program().output();
        EXPECT_EQ(
            ask(server.port(), "PUT", "/v1/sessions/hers", {bearer(alice), kJson}, kSquare).status,
            201);
        server.program().send_signal(SIGKILL);
        server.program().wait();
    }
    const std::string renewed = key_in(run({"key", "renew", "alice", "--data", data()}));
    ServerUnderTest server({"--data", data()});
    ASSERT_NE(server.port(), 0) << server.program().output();
    const auto status = [&](const std::string& key, const std::string& id) {
        return ask(server.port(), "GET", "/v1/sessions/" + id, {bearer(key)}).status;
    };
    EXPECT_EQ(status(alice, "hers"), 401) << "the old key is none any more";
    EXPECT_EQ(status(renewed, "hers"), 200);
    EXPECT_EQ(status(bob, "hers"), 404);
    EXPECT_EQ(status(renewed, "old"), 200);
    EXPECT_EQ(status(bob, "old"), 200);
    EXPECT_EQ(server.stop(), "");
}

TEST_F(KeyedService, ReadsItsKeysAgainOnHangup) {
    const std::string alice = add("alice");
    ServerUnderTest server({"--data", data()});
    ASSERT_NE(server.port(), 0) << server.program().output();
    const auto status = [&](const std::string& key) {
        return ask(server.port(), "GET", "/v1/sessions", {bearer(key)}).status;
    };
    const std::string bob = add("bob");
    EXPECT_EQ(status(bob), 401);
    server.program().send_signal(SIGHUP);
    EXPECT_TRUE(becomes_true([&] { return status(bob) == 200; }));
    EXPECT_EQ(run({"key", "remove", "bob", "--data", data()}).substr(0, 2), "0 ");
    server.program().send_signal(SIGHUP);
    EXPECT_TRUE(becomes_true([&] { return status(bob) == 401; }));
    EXPECT_EQ(status(alice), 200);
    const std::string good = content_of(data() + "/keys");
    write_content(data() + "/keys", "nonsense\n");
    server.program().send_signal(SIGHUP);
    EXPECT_TRUE(becomes_true(
        [&] { return server.program().output().find("keys_refused") != std::string::npos; }));
    EXPECT_EQ(status(alice), 200) << "the keys of before stay in force";
    write_content(data() + "/keys", "");
    server.program().send_signal(SIGHUP);
    EXPECT_TRUE(becomes_true([&] { return status(alice) == 401; })) << "no keys open nothing";
    EXPECT_EQ(ask(server.port(), "GET", "/v1/sessions").status, 401);
    write_content(data() + "/keys", good);
    server.program().send_signal(SIGHUP);
    EXPECT_TRUE(becomes_true([&] { return status(alice) == 200; }));
    server.program().send_signal(SIGTERM);
    EXPECT_EQ(server.program().wait(), 0);
}

/// Before a byte of the body is read, and with the connection closed behind it.
TEST_F(KeyedService, RefusesStrangersByTheHeadAlone) {
    const std::string alice = add("alice");
    ServerUnderTest server({"--data", data()});
    ASSERT_NE(server.port(), 0) << server.program().output();
    Connection upload(server.port());
    upload.send(
        "POST /v1/sessions HTTP/1.1\r\nHost: x\r\nContent-Type: text/csv\r\n"
        "Content-Length: 200000000\r\n\r\n");
    const Answer refused = upload.read();
    EXPECT_EQ(refused.status, 401);
    EXPECT_EQ(refused.header("www-authenticate"), "Bearer realm=\"tinsmith\"");
    EXPECT_EQ(json::parse(refused.body)["type"], "urn:tinsmith:problem:api-key-required");
    EXPECT_TRUE(upload.is_closed());
    Connection polite(server.port());
    polite.send(
        "POST /v1/sessions HTTP/1.1\r\nHost: x\r\nContent-Type: text/csv\r\n"
        "Content-Length: 200000000\r\nExpect: 100-continue\r\n\r\n");
    EXPECT_EQ(polite.read().status, 401) << "no 100 first";
    // What has no body keeps its connection.
    Connection reader(server.port());
    reader.send(request_text("GET", "/v1/sessions"));
    EXPECT_EQ(reader.read().status, 401);
    reader.send(request_text("GET", "/v1/sessions", {bearer(alice)}));
    EXPECT_EQ(reader.read().status, 200);
    EXPECT_EQ(server.stop(), "");
}

TEST_F(KeyedService, LetsPagesOfOtherOriginsAsk) {
    const std::string alice = add("alice");
    ServerUnderTest server({"--data", data(), "--cors-origin", "https://maps.example"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    const Answer preflight =
        ask(server.port(), "OPTIONS", "/v1/sessions",
            {"Origin: https://maps.example", "Access-Control-Request-Method: POST",
             "Access-Control-Request-Headers: authorization, content-type"});
    EXPECT_EQ(preflight.status, 200);
    EXPECT_EQ(preflight.header("access-control-allow-origin"), "https://maps.example");
    EXPECT_EQ(preflight.header("access-control-allow-headers"), "authorization, content-type");
    const Answer refused =
        ask(server.port(), "GET", "/v1/sessions", {"Origin: https://maps.example"});
    EXPECT_EQ(refused.status, 401);
    EXPECT_EQ(refused.header("access-control-allow-origin"), "https://maps.example")
        << "the page has to see why";
    EXPECT_NE(refused.header("access-control-expose-headers").find("WWW-Authenticate"),
              std::string::npos);
    EXPECT_EQ(server.stop(), "");
}

TEST_F(KeyedService, HoldsKeysToTheirQuotas) {
    const std::string alice = add("alice", {"--max-requests-per-second", "3"});
    const std::string bob = add("bob", {"--max-requests", "2"});
    ServerUnderTest server({"--data", data()});
    ASSERT_NE(server.port(), 0) << server.program().output();
    std::multiset<int> statuses;
    Answer refused;
    for (int i = 0; i < 30; ++i) {
        const Answer answer = ask(server.port(), "GET", "/v1/limits", {bearer(alice)});
        statuses.insert(answer.status);
        if (answer.status == 429) refused = answer;
    }
    EXPECT_GE(statuses.count(200), 3U);
    ASSERT_GE(statuses.count(429), 1U);
    EXPECT_EQ(statuses.count(200) + statuses.count(429), 30U);
    EXPECT_EQ(refused.header("retry-after"), "1");
    EXPECT_NE(refused.body.find("max_requests_per_second"), std::string::npos);
    // Bodies on their way count as under way: who has been invited to send one is in.
    Connection one(server.port()), two(server.port());
    for (Connection* slow : {&one, &two}) {
        slow->send("POST /v1/sessions HTTP/1.1\r\nHost: x\r\nContent-Type: text/csv\r\n" +
                   bearer(bob) + "\r\nContent-Length: 10\r\nExpect: 100-continue\r\n\r\n");
        EXPECT_EQ(slow->read().status, 100);
    }
    const Answer third = ask(server.port(), "GET", "/v1/limits", {bearer(bob)});
    EXPECT_EQ(third.status, 429);
    EXPECT_NE(third.body.find("quota max_requests of"), std::string::npos) << third.body;
    for (Connection* slow : {&one, &two})
        slow->send("1,2,3\n4,5,");
    EXPECT_NE(one.read().status, 0);
    EXPECT_NE(two.read().status, 0);
    EXPECT_TRUE(becomes_true(
        [&] { return ask(server.port(), "GET", "/v1/limits", {bearer(bob)}).status == 200; }));
    EXPECT_EQ(server.stop(), "");
}

}  // namespace
}  // namespace tinsmith::e2e
