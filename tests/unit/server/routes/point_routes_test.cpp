// SPDX-License-Identifier: Apache-2.0
// Terrains of points, as a client sends them.
#include <fstream>
#include <iterator>

#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

class PointRoutes : public Handlers {
  protected:
    Response send_csv(const std::string& text) {
        return ask("PUT", "/v1/sessions/spots", {{"content-type", "text/csv; charset=utf-8"}},
                   text);
    }
};

TEST_F(PointRoutes, TakePointsAndNameThoseAtFault) {
    const Response made =
        post("/v1/sessions", R"({"points": [[0,0,0],[10,0,1],[10,10,2],[0,10,3],[4,5,6]]})");
    ASSERT_EQ(made.status, 201) << made.body;
    const auto session = json::parse(made.body);
    EXPECT_EQ(session["vertices"], 5);
    EXPECT_EQ(session["triangles"], 4);
    const std::string path = header(made, "Location");
    EXPECT_EQ(post(path + "/polygons", kParcel).status, 200);
    EXPECT_EQ(json::parse(ask("GET", path + "/mesh.json?version=1").body)["vertices"][4],
              json::parse("[4.0, 5.0, 6.0]"));

    const Response refused = post(
        "/v1/sessions", R"({"points": [[0,0,0],[10,0,1],[10,10,2],[10,0,1],[10,0,2],[0,0,9]]})");
    EXPECT_EQ(refused.status, 422);
    EXPECT_EQ(told(refused), "ELEVATION_TWICE ELEVATION_TWICE");
    const auto errors = json::parse(refused.body)["errors"];
    EXPECT_EQ(errors[0]["pointer"], "/points/4");
    EXPECT_EQ(errors[0]["coordinate"], json::parse("[10.0, 0.0]"));
    EXPECT_EQ(errors[1]["pointer"], "/points/5");
    EXPECT_EQ(told(post("/v1/sessions", R"({"points": []})")), "TOO_FEW_POINTS");
}

TEST_F(PointRoutes, TakeCsv) {
    std::ifstream file(TINSMITH_SOURCE_DIR "/tests/data/spot_heights.csv");
    const Response made = send_csv({std::istreambuf_iterator<char>(file), {}});
    ASSERT_EQ(made.status, 201) << made.body;
    EXPECT_EQ(json::parse(made.body)["vertices"], 12);
    EXPECT_EQ(json::parse(made.body)["unit"], "metre");
    EXPECT_EQ(ask("DELETE", "/v1/sessions/spots").status, 200);
    const Response refused = send_csv("x;y;z\n0;0;0\n1;zero;1\n0;1\n");
    EXPECT_EQ(refused.status, 422);
    EXPECT_EQ(told(refused), "NUMBER_INVALID WRONG_LENGTH");
    EXPECT_EQ(json::parse(refused.body)["errors"][0]["detail"],
              "Line 3, column 3: \"zero\" is no number; write it like -12.5 or 1.2e3.");
    EXPECT_EQ(ask("GET", "/v1/sessions/spots").status, 404);
    std::string many = "0,0,0\n";
    for (int i = 0; i < 1000; ++i)
        many += std::to_string(i) + ",1,2\n";
    EXPECT_EQ(told(send_csv(many)), "TOO_MANY_VERTICES") << "max_vertices is 1000 here";
}

}  // namespace
}  // namespace tinsmith::server
