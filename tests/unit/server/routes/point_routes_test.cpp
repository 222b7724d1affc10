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

/// Of 5 points around a place north of Trondheim, where a degree of longitude is less than half of
/// one of latitude, so that the triangles in degrees would be others.
constexpr const char* kFarNorth = R"({"crs": "EPSG:4326", "points": [[10,64,0],[10.02,64,1],
    [10.02,64.01,2],[10,64.012,3],[10.009,64.004,6],[10.013,64.0078,4]]})";

TEST_F(PointRoutes, AreTriangulatedInThePlanAndNotInDegrees) {
    const Response made = post("/v1/sessions?project=auto", kFarNorth);
    ASSERT_EQ(made.status, 201) << made.body;
    const json session = json::parse(made.body);
    EXPECT_EQ(session["crs"], "EPSG:32632");
    const json mesh = json::parse(ask("GET", header(made, "Location") + "/mesh.json").body);
    // The same points, given in the plan at once.
    const json plan{{"points", mesh["vertices"]}};
    const Response again = post("/v1/sessions", plan.dump());
    ASSERT_EQ(again.status, 201) << again.body;
    EXPECT_EQ(json::parse(ask("GET", header(again, "Location") + "/mesh.json").body), mesh);
    // And in degrees, taken for a plan.
    json degrees = json::parse(kFarNorth);
    degrees.erase("crs");
    const Response flat = post("/v1/sessions", degrees.dump());
    ASSERT_EQ(flat.status, 201) << flat.body;
    EXPECT_NE(json::parse(ask("GET", header(flat, "Location") + "/mesh.json").body)["triangles"],
              mesh["triangles"])
        << "the points tell nothing";
}

TEST_F(PointRoutes, FaultsOfProjectedPointsAreNamedAsBefore) {
    const Response twice = post("/v1/sessions?project=auto", R"({"crs": "EPSG:4326",
        "points": [[10,64,0],[10.1,64,1],[10,64.1,2],[10.1,64,5]]})");
    EXPECT_EQ(told(twice), "ELEVATION_TWICE");
    EXPECT_EQ(json::parse(twice.body)["errors"][0]["pointer"], "/points/3");
    const Response beyond = post("/v1/sessions?project=EPSG:32632", R"({"crs": "EPSG:4326",
        "points": [[10,64,0],[10.1,64,1],[10,95,2]]})");
    EXPECT_EQ(told(beyond), "COORDINATE_OUT_OF_RANGE");
    EXPECT_EQ(json::parse(beyond.body)["errors"][0]["pointer"], "/points/2");
    const Response csv =
        ask("PUT", "/v1/sessions/spots?crs=EPSG:4326&project=auto", {{"content-type", "text/csv"}},
            "lon,lat,z\n10,64,0\n10.1,64,1\n10,64.1,2\n\n10.1,64,5\n");
    EXPECT_EQ(told(csv), "ELEVATION_TWICE");
    EXPECT_EQ(json::parse(csv.body)["errors"][0]["detail"].get<std::string>().substr(0, 8),
              "Line 6: ")
        << csv.body;
    const Response line =
        ask("PUT", "/v1/sessions/spots?crs=EPSG:4326&project=EPSG:32632",
            {{"content-type", "text/csv"}}, "lat,lon,z\n64,10,0\n64,10.1,1\n95,10,2\n");
    EXPECT_EQ(told(line), "COORDINATE_OUT_OF_RANGE");
    EXPECT_EQ(json::parse(line.body)["errors"][0]["detail"].get<std::string>().substr(0, 8),
              "Line 4: ");
}

TEST_F(PointRoutes, TakeCsvInDegreesWhereItIsSaidHow) {
    const std::string text = "latitude,longitude,height\n64,10,0\n64,10.1,1\n64.1,10,2\n";
    const Response made = ask("PUT", "/v1/sessions/spots?crs=EPSG:4326&project=auto",
                              {{"content-type", "text/csv"}}, text);
    ASSERT_EQ(made.status, 201) << made.body;
    EXPECT_EQ(json::parse(made.body)["crs"], "EPSG:32632");
    EXPECT_NEAR(json::parse(made.body)["bounds"][1], 7098000, 10000) << "north";
    EXPECT_EQ(ask("DELETE", "/v1/sessions/spots").status, 200);
    const Response refused = send_csv(text);
    EXPECT_EQ(told(refused), "CRS_GEOGRAPHIC CRS_GEOGRAPHIC");
    EXPECT_NE(refused.body.find("crs=EPSG:4326"), std::string::npos);
}

}  // namespace
}  // namespace tinsmith::server
