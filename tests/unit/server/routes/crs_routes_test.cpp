// SPDX-License-Identifier: Apache-2.0
// Coordinates in other systems than the session's, on every route that takes some.
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

/// A square of 1 km by the lake of the bundled terrain; z is x - 758000.
constexpr const char* kTerrain = R"({"crs": "EPSG:32616", "mesh": {"vertices":
    [[758000,4026000,0],[759000,4026000,1000],[759000,4027000,1000],[758000,4027000,0]],
    "triangles": [[0,1,2],[0,2,3]]}})";

// By cs2cs of PROJ 9.1.1: (758200, 4026100), (758400, 4026100) and (758500, 4026500).
constexpr const char* kInDegrees = R"([-84.122937739426,36.345370307933],
    [-84.120711725372,36.345316650674],[-84.119465952621,36.348891405532])";

std::string polygon_in_degrees(const std::string& members = {}) {
    return R"({"type": "Polygon", "coordinates": [[)" + std::string(kInDegrees) +
           R"(,[-84.122937739426,36.345370307933]]])" + members + "}";
}
std::string line_in_degrees(const std::string& members = {}) {
    return R"({"type": "LineString", "coordinates": [)" + std::string(kInDegrees) + "]" + members +
           "}";
}

class CrsRoutes : public Handlers {
  protected:
    std::string session = header(post("/v1/sessions", kTerrain), "Location");

    json good(const Response& response) {
        EXPECT_LT(response.status, 300) << response.body;
        return json::parse(response.body);
    }
    static std::string places(const Response& response) {
        std::string list;
        const json body = json::parse(response.body);
        for (const json& error : body["errors"])
            list += (list.empty() ? "" : " ") + error.value("pointer", "-");
        return list;
    }
    /// The first corner of the session's first polygon.
    void expect_in_place() {
        const json ring =
            good(ask("GET", session + "/polygons"))["features"][0]["geometry"]["coordinates"][0];
        EXPECT_NEAR(ring[0][0], 758200, 0.001);
        EXPECT_NEAR(ring[0][1], 4026100, 0.001);
        EXPECT_NEAR(ring[0][2], 200, 0.001);
    }
};

TEST_F(CrsRoutes, PolygonsComeByQuery) {
    good(post(session + "/polygons?crs=EPSG:4326", polygon_in_degrees()));
    expect_in_place();
}

TEST_F(CrsRoutes, PolygonsComeByOptionInTheBody) {
    good(post(session + "/polygons", polygon_in_degrees(R"(, "tinsmith": {"crs": "EPSG:4326"})")));
    expect_in_place();
}

TEST_F(CrsRoutes, PolygonsComeByTheMemberOf2008) {
    good(post(session + "/polygons?crs=EPSG:4326", polygon_in_degrees(R"(, "crs": {"type": "name",
        "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}})")));
    expect_in_place();
}

TEST_F(CrsRoutes, PolygonsComeByTheMemberOfJsonFg) {
    good(post(session + "/polygons", polygon_in_degrees(R"(, "coordRefSys": "[OGC:CRS84]")")));
    expect_in_place();
}

TEST_F(CrsRoutes, TheHistoryIsOfTheSessionsCoordinates) {
    good(post(session + "/polygons?crs=EPSG:4326", polygon_in_degrees()));
    const std::string mesh = ask("GET", session + "/mesh.json").body;
    good(ask("POST", session + "/undo"));
    good(ask("POST", session + "/redo"));
    EXPECT_EQ(ask("GET", session + "/mesh.json").body, mesh);
    expect_in_place();
}

TEST_F(CrsRoutes, LocksComeInDegreesToo) {
    good(post(session + "/polygons?crs=EPSG:4326", polygon_in_degrees()));
    const json locked = good(ask("PUT", session + "/locks?crs=EPSG:4326",
                                 {{"content-type", "application/json"}}, polygon_in_degrees()));
    EXPECT_GE(locked["edges"], 3);
    EXPECT_EQ(locked["without_edge"], json::array());
    EXPECT_EQ(
        told(ask("PUT", session + "/locks?crs=EPSG:4326", {{"content-type", "application/json"}},
                 R"({"type": "LineString", "coordinates": [[1,2],[-84.1,95]]})")),
        "CRS_TRANSFORM COORDINATE_OUT_OF_RANGE");
}

TEST_F(CrsRoutes, ElevationsAreAskedInDegreesAndAnsweredInMetres) {
    const json one =
        good(ask("GET", session + "/elevation?x=-84.122937739426&y=36.345370307933&crs=EPSG:4326"));
    EXPECT_NEAR(one["elevation"], 200, 0.001);
    const json many = good(post(session + "/elevation?crs=OGC:CRS84",
                                R"({"points": [[-84.122937739426,36.345370307933],[-84,36]]})"));
    EXPECT_NEAR(many["points"][0]["elevation"], 200, 0.001) << many;
    EXPECT_NEAR(many["points"][0]["x"], one["x"], 0.001);
    EXPECT_NEAR(many["points"][0]["y"], one["y"], 0.001);
    EXPECT_EQ(many["points"][1]["reason"], "outside-mesh");
    EXPECT_GT(many["points"][1]["x"], 760000) << "off the mesh, and told where all the same";
    const json own = good(post(session + "/elevation", R"({"points": [[758200,4026500]]})"));
    EXPECT_FALSE(own["points"][0].contains("x")) << "nothing was brought over";
    const Response swapped =
        ask("GET", session + "/elevation?y=-84.122937739426&x=36.345370307933&crs=EPSG:4326");
    EXPECT_EQ(swapped.status, 400);
    EXPECT_EQ(told(swapped), "CRS_OUT_OF_AREA");
    const Response bad = post(session + "/elevation?crs=EPSG:4326", R"({"points": [[1,95]]})");
    EXPECT_EQ(places(bad), "/points/0");
    EXPECT_EQ(ask("GET", session + "/elevation?x=1&y=2&crs=here").status, 400);
    EXPECT_EQ(post(session + "/elevation?crs=here", R"({"points": [[1,2]]})").status, 400);
}

TEST_F(CrsRoutes, ProfilesComeInDegreesToo) {
    for (const json& profile :
         {good(post(session + "/profile?crs=EPSG:4326", line_in_degrees())),
          good(post(session + "/profile", line_in_degrees(R"(, "coordRefSys": "[EPSG:4326]")")))}) {
        const json& points = profile["stretches"][0]["points"];
        EXPECT_NEAR(points.front()["position"][0], 758200, 0.001) << profile;
        EXPECT_NEAR(points.back()["position"][1], 4026500, 0.001);
    }
    EXPECT_EQ(told(post(session + "/profile?crs=EPSG:32616",
                        line_in_degrees(R"(, "coordRefSys": "[EPSG:4326]")"))),
              "CONTRADICTION");
}

TEST_F(CrsRoutes, WhatIsNotUnderstoodIsNamed) {
    const Response unknown = post(session + "/polygons?crs=EPSG:999999", polygon_in_degrees());
    EXPECT_EQ(unknown.status, 422);
    EXPECT_EQ(told(unknown), "CRS_UNKNOWN");
    EXPECT_EQ(json::parse(unknown.body)["errors"][0]["parameter"], "crs");
    const Response in_body =
        post(session + "/polygons", polygon_in_degrees(R"(, "tinsmith": {"crs": "EPSG:999999"})"));
    EXPECT_EQ(places(in_body), "/tinsmith/crs");
    session = header(post("/v1/sessions", R"({"mesh": {"vertices": [[0,0,0],[1,0,0],[0,1,0]],
                                          "triangles": [[0,1,2]]}})"),
                     "Location");
    const Response nowhere = post(session + "/polygons?crs=EPSG:4326", polygon_in_degrees());
    EXPECT_EQ(told(nowhere), "CRS_MISMATCH");
    EXPECT_NE(nowhere.body.find("no named system"), std::string::npos) << nowhere.body;
}

TEST_F(CrsRoutes, TerrainsAreRefusedWhereTheirSystemCannotBe) {
    const auto make = [this](const std::string& members) {
        return post("/v1/sessions", "{" + members + R"(, "mesh": {"vertices":
            [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]]}})");
    };
    const Response degrees = make(R"("crs": "EPSG:4326")");
    EXPECT_EQ(told(degrees), "CRS_GEOGRAPHIC");
    EXPECT_EQ(places(degrees), "/crs");
    EXPECT_NE(degrees.body.find("project=auto"), std::string::npos);
    EXPECT_EQ(told(make(R"("crs": "EPSG:999999")")), "CRS_UNKNOWN");
    EXPECT_EQ(places(make(R"("crs": "EPSG:2263", "unit": "metre")")), "/unit");
    EXPECT_EQ(good(make(R"("crs": "EPSG:2263")"))["unit"], "US survey foot");
}

TEST_F(CrsRoutes, AGridAsTextIsATerrain) {
    const Response made =
        ask("POST", "/v1/sessions", {{"content-type", "text/plain"}},
            "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2 3\n4 5 6\n");
    EXPECT_EQ(made.status, 201) << made.body;
    EXPECT_EQ(good(made)["vertices"], 6);
    const Response bad =
        ask("POST", "/v1/sessions", {{"content-type", "text/plain"}},
            "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 x 3\n4 5 6\n");
    EXPECT_EQ(bad.status, 400);
    EXPECT_NE(bad.body.find("line 6, column 3"), std::string::npos) << bad.body;
}

}  // namespace
}  // namespace tinsmith::server
