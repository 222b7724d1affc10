// SPDX-License-Identifier: Apache-2.0
// The binary as a server: how it starts, serves, refuses and stops.
#include <csignal>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/e2e/program.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {
namespace {

using nlohmann::json;

const std::string kJson = "Content-Type: application/json";
const std::string kSquare =
    R"({"mesh": {"vertices": [[0,0,0],[10,0,1],[10,10,2],[0,10,3]],
                 "triangles": [[0,1,2],[0,2,3]]}})";

/// One server for all tests of a suite; at the end its log must be clean and its exit code 0.
class Service : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        server = new ServerUnderTest({"--max-body-bytes", "12000000"});
        ASSERT_NE(server->port(), 0) << server->program().output();
    }
    static void TearDownTestSuite() {
        EXPECT_EQ(server->stop(), "");
        delete server;
        server = nullptr;
    }

    static int port() { return server->port(); }

    static std::string make_session() {
        const Answer made = ask(port(), "POST", "/v1/sessions", {kJson}, kSquare);
        EXPECT_EQ(made.status, 201) << made.body;
        return made.header("location");
    }

    /// A problem of that status, with everything that a problem has.
    static void expect_problem(const Answer& answer, int status) {
        EXPECT_EQ(answer.status, status) << answer.body.substr(0, 500);
        EXPECT_EQ(answer.header("content-type"), "application/problem+json");
        const auto body = json::parse(answer.body, nullptr, false);
        ASSERT_TRUE(body.is_object()) << answer.body.substr(0, 500);
        EXPECT_EQ(body["status"], status);
        EXPECT_NE(body["detail"], "");
        EXPECT_EQ(body["request_id"], answer.header("x-request-id"));
    }

    static void expect_healthy() { EXPECT_EQ(ask(port(), "GET", "/healthz").status, 200); }

    static inline ServerUnderTest* server = nullptr;
};

TEST_F(Service, TakesPostsWithoutALengthAsEmptyAndGoesOn) {
    const std::string session = make_session();
    Connection connection(port());
    for (int round = 0; round < 3; ++round) {
        connection.send("POST " + session + "/undo HTTP/1.1\r\nHost: x\r\n\r\n");
        expect_problem(connection.read(), 409);
        connection.send("POST /v1/sessions HTTP/1.1\r\nHost: x\r\n" + kJson + "\r\n\r\n");
        expect_problem(connection.read(), 400);
        connection.send("DELETE /v1/sessions/none HTTP/1.1\r\nHost: x\r\n\r\n");
        expect_problem(connection.read(), 404);
        connection.send("GET " + session + " HTTP/1.1\r\nHost: x\r\n\r\n");
        EXPECT_EQ(connection.read().status, 200);
    }
}

TEST_F(Service, GoesBackAndForth) {
    const std::string session = make_session();
    const std::string polygon = R"({"type": "Polygon",
        "coordinates": [[[2,2],[5,2],[5,5],[2,5],[2,2]]]})";
    const std::string as_delta = "Accept: application/vnd.tinsmith.delta";
    const std::string before = ask(port(), "GET", session + "/mesh.json").body;
    const Answer made = ask(port(), "POST", session + "/polygons", {kJson, as_delta}, polygon);
    EXPECT_EQ(made.status, 200);
    EXPECT_EQ(made.header("content-type"), "application/vnd.tinsmith.delta");
    EXPECT_EQ(made.body.substr(0, 4), "TNDL");
    EXPECT_EQ(ask(port(), "GET", session + "/mesh?since=1", {as_delta}).body, made.body);
    const std::string after = ask(port(), "GET", session + "/mesh.json").body;
    EXPECT_EQ(ask(port(), "POST", session + "/undo").status, 200);
    EXPECT_EQ(ask(port(), "GET", session + "/mesh.json").body, before);
    EXPECT_EQ(ask(port(), "POST", session + "/redo").status, 200);
    EXPECT_EQ(ask(port(), "GET", session + "/mesh.json").body, after);
    EXPECT_EQ(ask(port(), "DELETE", session + "/polygons/p1").status, 200);
    EXPECT_EQ(ask(port(), "GET", session + "/mesh.json").body, before);
    expect_problem(ask(port(), "POST", session + "/redo"), 409);
    expect_problem(ask(port(), "GET", session + "/mesh?since=6"), 404);
    EXPECT_EQ(json::parse(ask(port(), "GET", session + "/history").body)["changes"].size(), 5U);
}

TEST_F(Service, KeepsAConnectionForMoreThanFiveRequests) {
    Connection connection(port());
    for (int i = 0; i < 50; ++i) {
        connection.send(request_text("GET", "/healthz"));
        ASSERT_EQ(connection.read().status, 200) << "request " << i;
    }
}

TEST_F(Service, CarriesTheRequestId) {
    EXPECT_EQ(ask(port(), "GET", "/healthz", {"X-Request-Id: my-id.7"}).header("x-request-id"),
              "my-id.7");
    const std::string made = ask(port(), "GET", "/healthz").header("x-request-id");
    EXPECT_EQ(made.size(), 16U);
    EXPECT_EQ(ask(port(), "GET", "/x", {"X-Request-Id: a b"}).header("x-request-id").size(), 16U);
}

TEST_F(Service, AnswersHeadWithoutABody) {
    Connection connection(port());
    connection.send(request_text("HEAD", "/healthz"));
    EXPECT_EQ(connection.read(true).header("content-length"), "16");
    connection.send(request_text("GET", "/healthz"));
    EXPECT_EQ(connection.read().status, 200);
}

TEST_F(Service, TellsWhatASessionWasWhenItEnds) {
    const std::string session = make_session();
    Connection connection(port());
    connection.send(request_text("DELETE", session));
    const Answer gone = connection.read();
    EXPECT_EQ(gone.status, 200);
    EXPECT_EQ(gone.header("content-length"), std::to_string(gone.body.size()));
    EXPECT_NE(gone.body.find("\"version\":1"), std::string::npos) << gone.body;
    connection.send(request_text("GET", session));
    expect_problem(connection.read(), 404);
}

TEST_F(Service, LeavesShortAnswersPlainAndWhole) {
    const Answer plain = ask(port(), "GET", "/v1/limits");
    EXPECT_EQ(ask(port(), "GET", "/v1/limits", {"Accept-Encoding: gzip, br"}).body, plain.body);
    const Answer ranged = ask(port(), "GET", "/v1/limits", {"Range: bytes=0-3"});
    EXPECT_EQ(ranged.status, 200);
    EXPECT_EQ(ranged.body, plain.body);
}

TEST_F(Service, TellsCurlUsersWhatToAdd) {
    const std::string form = "Content-Type: application/x-www-form-urlencoded";
    for (const std::size_t size : {std::size_t{10}, std::size_t{1} << 20}) {
        const Answer answer = ask(port(), "POST", "/v1/sessions", {form}, std::string(size, 'a'));
        expect_problem(answer, 415);
        EXPECT_NE(answer.body.find("-H 'Content-Type: application/json'"), std::string::npos);
    }
    expect_problem(ask(port(), "POST", "/v1/sessions",
                       {"Content-Type: multipart/form-data; boundary=x"}, "--x--"),
                   415);
}

TEST_F(Service, RefusesBadPolygonsAndChangesNothing) {
    const std::string session = make_session();
    const std::string before = ask(port(), "GET", session + "/mesh.json").body;
    struct Case {
        std::string body;
        int status;
        std::string place;  ///< the pointer that names it; empty: the whole body
    };
    const std::string open = R"({"type": "Polygon", "coordinates": [[)";
    const std::vector<Case> cases{
        {open + "[NaN,2],[5,2],[5,5],[2,2]]]}", 400, ""},
        {open + "[1e999,2],[5,2],[5,5],[1e999,2]]]}", 422, "/coordinates/0/0"},
        {open + "[2,\"2\"],[5,2],[5,5],[2,2]]]}", 422, "/coordinates/0/0"},
        {open + "[2,2],[5,2]]]}", 422, "/coordinates/0"},
        {R"({"type": "Polygon", "coordinates": [[[2,2],[5,2],[5,5],[2,2]]],
             "tinsmith": {"colour": "red"}})",
         422, "/tinsmith/colour"},
        {std::string(10'000'000, '['), 400, ""},
    };
    for (const Case& c : cases) {
        const Answer answer = ask(port(), "POST", session + "/polygons", {kJson}, c.body);
        SCOPED_TRACE(c.body.substr(0, 100));
        expect_problem(answer, c.status);
        if (!c.place.empty()) {
            EXPECT_NE(answer.body.find("\"pointer\":\"" + c.place), std::string::npos)
                << answer.body;
        }
        expect_healthy();
    }
    EXPECT_EQ(json::parse(ask(port(), "GET", session).body)["version"], 1);
    EXPECT_EQ(ask(port(), "GET", session + "/mesh.json").body, before);
}

TEST_F(Service, RefusesBadTerrains) {
    const Answer answer = ask(port(), "POST", "/v1/sessions", {kJson},
                              R"({"mesh": {"vertices": [[0,0,0]], "triangles": [[0,0,0]]},
                                  "colour": 1, "name": 5})");
    expect_problem(answer, 422);
    EXPECT_NE(answer.body.find("/colour"), std::string::npos);
    EXPECT_NE(answer.body.find("/name"), std::string::npos);
    expect_problem(ask(port(), "POST", "/v1/sessions", {kJson}, "not json"), 400);
    expect_problem(ask(port(), "POST", "/v1/sessions", {"Content-Type: image/tiff"}, "II*"), 400);
    expect_problem(ask(port(), "POST", "/v1/sessions", {"Content-Type: application/pdf"}, "1,2,3"),
                   415);
    expect_healthy();
}

TEST_F(Service, RefusesLongPaths) {
    for (const std::size_t length : {std::size_t{600}, std::size_t{5000}, std::size_t{100'000}}) {
        Connection connection(port());
        connection.send(request_text("GET", "/" + std::string(length, 'a')));
        expect_problem(connection.read(), 414);
        EXPECT_TRUE(connection.is_closed());
        expect_healthy();
    }
}

TEST_F(Service, RefusesUnknownSessions) {
    for (const char* path : {"/v1/sessions/none", "/v1/sessions/none/mesh.glb",
                             "/v1/sessions/..%2f..%2fetc%2fpasswd"}) {
        expect_problem(ask(port(), "GET", path), 404);
    }
    expect_problem(ask(port(), "POST", "/v1/sessions/none/polygons", {kJson}, "{}"), 404);
}

TEST_F(Service, EditsAMeshFromEndToEnd) {
    const std::string session = make_session();
    const Answer done = ask(port(), "POST", session + "/polygons", {kJson}, R"({"type": "Polygon",
        "coordinates": [[[2,2],[5,2],[5,5],[2,5],[2,2]]]})");
    ASSERT_EQ(done.status, 200) << done.body;
    EXPECT_EQ(json::parse(done.body)["version"], 2);
    const Answer mesh = ask(port(), "GET", session + "/mesh", {"Accept: application/json"});
    EXPECT_EQ(json::parse(mesh.body)["vertices"].size(), 8U);
    const Answer glb = ask(port(), "GET", session + "/mesh");
    EXPECT_EQ(glb.body.substr(0, 4), "glTF");
    EXPECT_EQ(glb.header("content-type"), "model/gltf-binary");
    EXPECT_NE(glb.header("tinsmith-max-error"), "");
}

TEST_F(Service, HonoursTheOptionsOfPolygons) {
    const std::string pad = R"({"type": "Polygon",
        "coordinates": [[[2,1,50],[5,1,50],[5,4,50],[2,4,50],[2,1,50]]]})";
    const auto cut = [&pad](const std::string& query) {
        return ask(port(), "POST", make_session() + "/polygons" + query, {kJson}, pad);
    };
    for (const std::string query :
         {"?elevation=own", "?elevation=own&on_crossing=old&lock=true",
          "?improve=bounded&max_deviation=0.25&snap=0.125", "?improve=paper&winding=nonzero"}) {
        const Answer done = cut(query);
        ASSERT_EQ(done.status, 200) << query << ": " << done.body;
        const bool is_own = query.find("own") != query.npos;
        EXPECT_EQ(json::parse(done.body)["polygons"][0]["max_elevation_change"] > 40.0, is_own)
            << done.body;
    }
    for (const std::string query : {"?on_crossing=old", "?improve=bounded", "?max_deviation=1",
                                    "?snap=-1", "?winding=left", "?lock=perhaps"}) {
        const Answer refused = cut(query);
        expect_problem(refused, 400);
        const std::string name = query.substr(1, query.find('=') - 1);
        EXPECT_EQ(json::parse(refused.body)["errors"][0]["parameter"], name);
    }
}

TEST_F(Service, SendsPolygonsBack) {
    const std::string session = make_session();
    const Answer done = ask(port(), "POST", session + "/polygons", {kJson}, R"({"type": "Feature",
        "properties": {"name": "pond"}, "geometry": {"type": "Polygon",
        "coordinates": [[[2,2],[5,2],[5,5],[2,5],[2,2]]]}})");
    ASSERT_EQ(done.status, 200) << done.body;
    const Answer all = ask(port(), "GET", session + "/polygons");
    EXPECT_EQ(all.status, 200);
    EXPECT_EQ(all.header("content-type"), "application/geo+json");
    EXPECT_EQ(json::parse(all.body)["features"][0]["properties"]["name"], "pond");
    const Answer one = ask(port(), "GET", session + "/polygons/p1");
    EXPECT_NEAR(json::parse(one.body)["tinsmith"]["plan_area"].get<double>(), 9.0, 1e-9);
    expect_problem(ask(port(), "GET", session + "/polygons/p9"), 404);
}

TEST_F(Service, WantsAllElevationsOrNone) {
    const Answer refused = ask(port(), "POST", make_session() + "/polygons?elevation=own", {kJson},
                               R"({"type": "LineString", "coordinates": [[1,1,5],[2,3],[4,4]]})");
    expect_problem(refused, 422);
    const json errors = json::parse(refused.body)["errors"];
    ASSERT_EQ(errors.size(), 2U);
    EXPECT_EQ(errors[0]["pointer"], "/coordinates/1");
    EXPECT_EQ(errors[1]["pointer"], "/coordinates/2");
}

TEST_F(Service, KeepsEveryEditOfManyClients) {
    constexpr int kClients = 4;
    constexpr int kEdits = 10;
    const std::string session = make_session();
    std::vector<std::thread> clients;
    for (int client = 0; client < kClients; ++client) {
        clients.emplace_back([client, &session] {
            for (int edit = 0; edit < kEdits; ++edit) {
                const std::string x = std::to_string(1 + client * 2);
                const std::string y = std::to_string(0.5 + edit * 0.75);
                const std::string line = R"({"type": "LineString", "coordinates": [[)" + x + "," +
                                         y + "],[" + x + ".5,9.5]]}";
                EXPECT_EQ(ask(port(), "POST", session + "/polygons", {kJson}, line).status, 200);
                EXPECT_EQ(ask(port(), "GET", session + "/mesh.glb").status, 200);
            }
        });
    }
    for (std::thread& client : clients)
        client.join();
    const auto after = json::parse(ask(port(), "GET", session).body);
    EXPECT_EQ(after["version"], 1 + kClients * kEdits);
    EXPECT_EQ(after["polygons"], kClients * kEdits);
}

TEST(ServiceStart, RefusesATakenPort) {
    ServerUnderTest first;
    ASSERT_NE(first.port(), 0) << first.program().output();
    const ScratchDirectory scratch;
    Program second({"serve", "--port", std::to_string(first.port())}, scratch.file("log"));
    EXPECT_EQ(second.wait(), 1);
    EXPECT_NE(second.output().find("cannot listen on 127.0.0.1:"), std::string::npos)
        << second.output();
    EXPECT_EQ(ask(first.port(), "GET", "/healthz").status, 200);
    EXPECT_EQ(first.stop(), "");
}

TEST(ServiceStart, LoadsTheDemoTerrain) {
    ServerUnderTest server({"--demo"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    const Answer demo = ask(server.port(), "GET", "/v1/sessions/demo");
    ASSERT_EQ(demo.status, 200) << demo.body;
    const auto session = json::parse(demo.body);
    EXPECT_EQ(session["name"], "Jacksboro fault");
    EXPECT_GT(session["triangles"], 100'000);
    const Answer done =
        ask(server.port(), "POST", "/v1/sessions/demo/polygons", {kJson},
            content_of(std::string(TINSMITH_SOURCE_DIR) + "/tests/data/lake.geojson"));
    EXPECT_EQ(done.status, 200) << done.body;
    EXPECT_EQ(server.stop(), "");
}

TEST_F(Service, AnswersQuestionsWhileEditsGoOn) {
    const std::string session = make_session();
    const Answer at = ask(port(), "GET", session + "/elevation?x=8&y=3");
    ASSERT_EQ(at.status, 200) << at.body;
    EXPECT_DOUBLE_EQ(json::parse(at.body)["elevation"].get<double>(), 1.1);
    EXPECT_EQ(at.header("etag"), ask(port(), "GET", session).header("etag"));
    expect_problem(ask(port(), "GET", session + "/elevation?x=-8&y=3"), 404);
    expect_problem(ask(port(), "GET", session + "/elevation?x=8"), 400);
    expect_problem(ask(port(), "POST", session + "/volume", {kJson}, "{}"), 422);

    const std::string line = R"({"type": "LineString", "coordinates": [[1,2],[9,2.5]]})";
    const std::string level = R"({"against": {"elevation": 0}})";
    std::thread editor([&] {
        for (int i = 1; i < 9; ++i) {
            const std::string x = std::to_string(i);
            EXPECT_EQ(
                ask(port(), "POST", session + "/polygons", {kJson},
                    R"({"type": "LineString", "coordinates": [[)" + x + ",1],[" + x + ".5,9]]}")
                    .status,
                200);
        }
    });
    for (int i = 0; i < 20; ++i) {
        const Answer volume = ask(port(), "POST", session + "/volume", {kJson}, level);
        ASSERT_EQ(volume.status, 200) << volume.body;
        EXPECT_NEAR(json::parse(volume.body)["cut"].get<double>(), 50.0 + 250.0 / 3.0, 1e-9);
        const Answer profile = ask(port(), "POST", session + "/profile", {kJson}, line);
        ASSERT_EQ(profile.status, 200) << profile.body;
        const auto found = json::parse(profile.body);
        EXPECT_NE(profile.header("etag").find("-" + found["version"].dump()), std::string::npos);
    }
    editor.join();
}

TEST(ServiceStart, WarnsBeyondThisMachine) {
    ServerUnderTest server({"--host", "0.0.0.0", "--insecure"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    EXPECT_NE(server.stop().find("WITHOUT KEYS"), std::string::npos);
}

TEST(ServiceStop, ObeysInterruptsToo) {
    ServerUnderTest server;
    ASSERT_NE(server.port(), 0);
    const Connection idle(server.port());
    server.program().send_signal(SIGINT);
    EXPECT_EQ(server.program().wait(), 0) << server.program().output();
}

}  // namespace
}  // namespace tinsmith::e2e
