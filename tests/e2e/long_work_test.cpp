// SPDX-License-Identifier: Apache-2.0
// Requests that are answered later, and the main job in one of them, with the real binary.
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

/// Half a million posts.
std::string large_grid() {
    std::string grid = R"({"grid": {"origin": [0,0], "cell": [1,1], "columns": 700, "rows": 700,
                           "elevations": [0)";
    for (int i = 1; i < 700 * 700; ++i)
        grid += i % 3 == 0 ? ",1" : ",2.5";
    return grid + "]}}";
}

/// One server for all tests of a suite; at the end its log must be clean and its exit code 0.
class LongWork : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        server = new ServerUnderTest;
        ASSERT_NE(server->port(), 0) << server->program().output();
    }
    static void TearDownTestSuite() {
        EXPECT_EQ(server->stop(), "");
        delete server;
        server = nullptr;
    }
    static int port() { return server->port(); }

    static inline ServerUnderTest* server = nullptr;
};

TEST_F(LongWork, IsDoneAsJobs) {
    const std::string grid = large_grid();
    const std::string later = "Prefer: respond-async";
    const Answer accepted = ask(port(), "POST", "/v1/sessions", {kJson, later}, grid);
    ASSERT_EQ(accepted.status, 202) << accepted.body;
    EXPECT_EQ(accepted.header("preference-applied"), later.substr(8));
    const std::string job = accepted.header("location");
    double progress = 0.0;
    json told;
    do {
        told = json::parse(ask(port(), "GET", job).body);
        EXPECT_GE(told["progress"], progress);
        progress = told["progress"];
    } while (told["status"].is_null());
    EXPECT_EQ(told["state"], "done");
    const Answer made = ask(port(), "GET", job + "/result");
    ASSERT_EQ(made.status, 201) << made.body;
    const std::string session = made.header("location");
    // Stopped or done: whatever it says has happened.
    const std::string line = R"({"type": "LineString", "coordinates": [[0.3,0.7],[690,698]]})";
    const Answer cut =
        ask(port(), "POST", session + "/polygons?improve=paper", {kJson, later}, line);
    const Answer ended = ask(port(), "DELETE", cut.header("location"));
    ASSERT_EQ(ended.status, 200) << ended.body;
    const json end = json::parse(ended.body);
    const json now = json::parse(ask(port(), "GET", session).body);
    EXPECT_EQ(now["version"], end["state"] == "done" ? 2 : 1) << end;
    EXPECT_EQ(now["polygons"], end["state"] == "done" ? 1 : 0);
    ask(port(), "DELETE", session);
}

TEST_F(LongWork, IntegratesInOneRequest) {
    const std::string form =
        "--x\r\nContent-Disposition: form-data; name=\"terrain\"; filename=\"t\"\r\n"
        "Content-Type: application/json\r\n\r\n" +
        kSquare +
        "\r\n--x\r\nContent-Disposition: form-data; name=\"polygons\"\r\n\r\n"
        R"({"type": "Polygon", "coordinates": [[[2,2],[5,2],[5,5],[2,2]]]})"
        "\r\n--x--\r\n";
    const std::string type = "Content-Type: multipart/form-data; boundary=x";
    const Answer report = ask(port(), "POST", "/v1/integrate", {type}, form);
    ASSERT_EQ(report.status, 200) << report.body;
    EXPECT_EQ(json::parse(report.body)["polygons"][0]["id"], "p1");
    const Answer glb =
        ask(port(), "POST", "/v1/integrate", {type, "Accept: model/gltf-binary"}, form);
    EXPECT_EQ(glb.body.substr(0, 4), "glTF");
}

TEST_F(LongWork, LocksEdgesAlongALine) {
    const std::string session =
        ask(port(), "POST", "/v1/sessions", {kJson}, kSquare).header("location");
    const std::string line = R"({"type": "LineString", "coordinates": [[0,0],[10,10]]})";
    for (const auto& [method, changed] : {std::pair("PUT", 1), {"PUT", 0}, {"DELETE", 1}}) {
        const Answer made = ask(port(), method, session + "/locks", {kJson}, line);
        ASSERT_EQ(made.status, 200) << made.body;
        EXPECT_EQ(json::parse(made.body)["changed"], changed);
    }
}

TEST(ServiceStop, EndsJobs) {
    ServerUnderTest server({"--job-threads", "1"});
    ASSERT_NE(server.port(), 0);
    for (int i = 0; i < 5; ++i) {
        const Answer accepted = ask(server.port(), "POST", "/v1/sessions",
                                    {kJson, "Prefer: respond-async"}, large_grid());
        EXPECT_EQ(accepted.status, 202);
    }
    EXPECT_EQ(server.stop(), "");
}

}  // namespace
}  // namespace tinsmith::e2e
