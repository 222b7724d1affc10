// SPDX-License-Identifier: Apache-2.0
// `tinsmith backup` beside a server that goes on.
#include <algorithm>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/e2e/program.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {
namespace {

const std::string kJson = "Content-Type: application/json";
const std::string kSession = "/v1/sessions/field";

std::string square_at(double x) {
    const auto at = [](double a, double b) {
        return "[" + std::to_string(a) + "," + std::to_string(b) + "]";
    };
    return R"({"type":"Polygon","coordinates":[[)" + at(x, 1) + "," + at(x + 0.5, 1) + "," +
           at(x + 0.5, 8) + "," + at(x, 8) + "," + at(x, 1) + "]]}";
}

class Backup : public testing::Test {
  protected:
    int back_up(const std::string& from, const std::string& to) {
        Program program({"backup", "--data", from, to}, scratch.file("output"));
        const int code = program.wait(std::chrono::seconds(60)).value_or(-1);
        output = program.output();
        return code;
    }

    ScratchDirectory scratch;
    std::string output;
};

TEST_F(Backup, OfALiveServerStartsOneThatHasTheSame) {
    const std::string data = scratch.file("data"), copy = scratch.file("copy");
    ServerUnderTest server({"--data", data});
    ASSERT_NE(server.port(), 0) << server.program().output();
    ASSERT_EQ(ask(server.port(), "PUT", kSession, {kJson},
                  R"({"mesh": {"vertices": [[0,0,0],[10,0,1],[10,10,2],[0,10,3]],
                               "triangles": [[0,1,2],[0,2,3]]}})")
                  .status,
              201);
    std::vector<std::string> meshes;  // by version, the first one is 1
    const auto see_mesh = [&] {
        meshes.push_back(ask(server.port(), "GET", kSession + "/mesh.json").body);
    };
    see_mesh();
    const auto cut = [&](int i) {
        EXPECT_EQ(
            ask(server.port(), "POST", kSession + "/polygons", {kJson}, square_at(1 + i)).status,
            200);
        see_mesh();
    };
    for (int i = 0; i < 3; ++i)
        cut(i);
    int code = -1;
    std::thread beside([&] { code = back_up(data, copy); });
    for (int i = 3; i < 8; ++i)
        cut(i);
    beside.join();
    ASSERT_EQ(code, 0) << output;
    EXPECT_NE(output.find(copy), std::string::npos) << output;
    EXPECT_EQ(server.stop(), "");

    ServerUnderTest other({"--data", copy});
    ASSERT_NE(other.port(), 0) << other.program().output();
    const Answer mesh = ask(other.port(), "GET", kSession + "/mesh.json");
    const Answer told = ask(other.port(), "GET", kSession + "/history");
    ASSERT_EQ(mesh.status, 200) << mesh.body;
    const auto same = std::find(meshes.begin(), meshes.end(), mesh.body);
    ASSERT_NE(same, meshes.end()) << "a mesh that never was: " << told.body;
    EXPECT_GE(same - meshes.begin(), 3) << "what was there before it began";
    EXPECT_EQ(other.stop(), "");
}

TEST_F(Backup, WritesNothingOverAndWantsAStore) {
    EXPECT_EQ(back_up(scratch.file("nowhere"), scratch.file("copy")), 1);
    EXPECT_NE(output.find("holds no store"), std::string::npos) << output;
    EXPECT_FALSE(std::filesystem::exists(scratch.file("copy")));

    const std::string data = scratch.file("data");
    ServerUnderTest server({"--data", data});
    ASSERT_NE(server.port(), 0) << server.program().output();
    EXPECT_EQ(back_up(data, scratch.file("copy")), 0) << output;
    EXPECT_EQ(back_up(data, scratch.file("copy")), 1);
    EXPECT_NE(output.find("nothing is written over"), std::string::npos) << output;
    EXPECT_EQ(back_up(data, data), 1);
    EXPECT_EQ(server.stop(), "");
}

}  // namespace
}  // namespace tinsmith::e2e
