// SPDX-License-Identifier: Apache-2.0
// The options of the polygons request, as far as a client sees what they do.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

class PolygonRoutes : public Handlers {
  protected:
    std::string session = make_session();

    Response cut(const std::string& query, const std::string& body) {
        return post(session + "/polygons" + query, body);
    }

    /// The report of an edit that is expected to be made.
    json report_of(const std::string& query, const std::string& body) {
        const Response done = cut(query, body);
        EXPECT_EQ(done.status, 200) << query << ": " << done.body;
        return done.status == 200 ? json::parse(done.body) : json{};
    }

    /// Of a vertex of the mesh as it is; NaN where none is there.
    double elevation_at(double x, double y) {
        const json mesh = json::parse(ask("GET", session + "/mesh.json").body);
        for (const json& vertex : mesh["vertices"]) {
            if (vertex[0] == x && vertex[1] == y) return vertex[2];
        }
        return std::nan("");
    }

    std::size_t vertices() {
        return json::parse(ask("GET", session + "/mesh.json").body)["vertices"].size();
    }

    /// The text chunk of a GLB, which comes first.
    static json glb_json(const std::string& glb) {
        std::uint32_t length = 0;
        std::memcpy(&length, glb.data() + 12, sizeof length);
        return json::parse(glb.substr(20, length));
    }

    json errors_of(const std::string& query, const std::string& body, int status) {
        const Response refused = cut(query, body);
        EXPECT_EQ(refused.status, status) << refused.body;
        EXPECT_EQ(version_of(session), 1);
        return json::parse(refused.body).value("errors", json::array());
    }
};

constexpr const char* kPad = R"({"type": "Polygon", "coordinates":
    [[[2,1,50],[5,1,50.5],[5,4,51],[2,4,50.25],[2,1,50]]]})";

TEST_F(PolygonRoutes, RefuseOptionsByNamePlaceAndRemedy) {
    EXPECT_EQ(told(cut("?colour=red", kParcel)), "UNKNOWN_PARAMETER");
    const json query = errors_of("?snap=-1&max_deviation=0.5&on_crossing=old", kParcel, 400);
    ASSERT_EQ(query.size(), 3U);
    EXPECT_EQ(query[0]["parameter"], "snap");
    EXPECT_EQ(query[1]["parameter"], "max_deviation");
    EXPECT_EQ(query[2]["parameter"], "on_crossing");
    EXPECT_FALSE(query[0].contains("pointer"));
    const json body = errors_of("", R"({"type": "Point", "coordinates": [2,2],
        "tinsmith": {"improve": "bounded", "lock": 1, "winding": "left"}})",
                                422);
    ASSERT_EQ(body.size(), 3U);
    EXPECT_EQ(body[0]["pointer"], "/tinsmith/lock");
    EXPECT_EQ(body[1]["pointer"], "/tinsmith/winding");
    EXPECT_EQ(body[2]["pointer"], "/tinsmith/improve");
    EXPECT_FALSE(body[0].contains("parameter"));
    for (const json& error : body)
        EXPECT_TRUE(error["detail"].get<std::string>().find("give ") != std::string::npos ||
                    error["detail"].get<std::string>().find("add ") != std::string::npos);
}

TEST_F(PolygonRoutes, KnowTheirSystem) {
    EXPECT_EQ(cut("?crs=EPSG:32616", kParcel).status, 200);
    EXPECT_EQ(told(cut("?crs=EPSG:25832", kParcel)).substr(0, 9), "CRS_TRANS");
}

TEST_F(PolygonRoutes, DrapeWhateverZIsWritten) {
    const json report = report_of("?elevation=drape", kPad);
    EXPECT_EQ(report["polygons"][0]["max_elevation_change"], 0.0);
    const std::string mesh = ask("GET", session + "/mesh.json").body;
    session = make_session();
    report_of("", R"({"type": "Polygon", "coordinates": [[[2,1],[5,1],[5,4],[2,4],[2,1]]]})");
    EXPECT_EQ(ask("GET", session + "/mesh.json").body, mesh);
}

TEST_F(PolygonRoutes, TakeTheirOwnElevations) {
    const json report = report_of("?elevation=own", kPad);
    EXPECT_EQ(elevation_at(2, 1), 50.0);
    EXPECT_EQ(elevation_at(5, 1), 50.5);
    EXPECT_EQ(elevation_at(5, 4), 51.0);
    EXPECT_EQ(elevation_at(2, 4), 50.25);
    EXPECT_GT(report["polygons"][0]["max_elevation_change"], 49.0);
    EXPECT_EQ(json::parse(ask("GET", session).body)["bounds"],
              json::parse("[0.0,0.0,0.0,10.0,10.0,51.0]"));
}

TEST_F(PolygonRoutes, TakeTheModeFromTheBodyAfterTheGeometry) {
    report_of("",
              R"({"type": "Point", "coordinates": [3,4,77], "tinsmith": {"elevation": "own"}})");
    EXPECT_EQ(elevation_at(3, 4), 77.0);
}

TEST_F(PolygonRoutes, SendTheRangeThatOwnElevationsMake) {
    report_of("?elevation=own", kPad);
    const Response glb = ask("GET", session + "/mesh.glb?compression=none&up=z");
    ASSERT_EQ(glb.status, 200) << glb.body;
    // Positions are relative to the middle of what is there, in whole metres.
    const json node = glb_json(glb.body)["nodes"][0];
    EXPECT_EQ(node["translation"], json::parse("[5.0,5.0,26.0]")) << node;
    EXPECT_EQ(ask("GET", session + "/mesh.glb").status, 200);
}

TEST_F(PolygonRoutes, SendTheMeshAsTheQueryWantsIt) {
    const Response plain =
        post(session + "/polygons?compression=none&up=z&improve=none&normals=false", kParcel,
             {{"accept", "model/gltf-binary"}});
    ASSERT_EQ(plain.status, 200) << plain.body;
    EXPECT_FALSE(glb_json(plain.body).contains("extensionsUsed"));
    EXPECT_EQ(plain.body,
              ask("GET", session + "/mesh.glb?compression=none&up=z&normals=false").body);
    const Response report = post(session + "/polygons?tolerance=0.1", kParcel);
    EXPECT_EQ(report.status, 400);
    EXPECT_EQ(json::parse(report.body)["errors"][0]["parameter"], "tolerance");
    const Response bad =
        post(session + "/polygons?tolerance=-1", kParcel, {{"accept", "model/gltf-binary"}});
    EXPECT_EQ(bad.status, 400);
    EXPECT_EQ(json::parse(ask("GET", session).body)["polygons"], 1) << "nothing was done";
}

TEST_F(PolygonRoutes, NameEveryPositionWithoutItsOwnElevation) {
    const json errors = errors_of("?elevation=own", R"({"type": "FeatureCollection", "features": [
        {"type": "Feature", "geometry": {"type": "Point", "coordinates": [1,2]}},
        {"type": "Feature", "geometry": {"type": "LineString",
                                         "coordinates": [[1,2,3],[4,5]]}},
        {"type": "Feature", "geometry": {"type": "Polygon",
                                         "coordinates": [[[2,1,5],[5,1,5],[5,4,5],[2,1,6]]]}}]})",
                                  422);
    ASSERT_EQ(errors.size(), 3U);
    EXPECT_EQ(errors[0]["code"], "ELEVATION_MISSING");
    EXPECT_EQ(errors[0]["pointer"], "/features/0/geometry/coordinates");
    EXPECT_EQ(errors[0]["coordinate"], json::parse("[1.0,2.0]"));
    EXPECT_EQ(errors[1]["code"], "ELEVATION_MISSING");
    EXPECT_EQ(errors[1]["pointer"], "/features/1/geometry/coordinates/1");
    EXPECT_EQ(errors[2]["code"], "RING_NOT_CLOSED");
    EXPECT_EQ(errors[2]["pointer"], "/features/2/geometry/coordinates/0/3");
}

TEST_F(PolygonRoutes, LetTheNewOrTheOldElevationWinWhereTheyCross) {
    const std::string first = R"({"type": "LineString", "coordinates": [[1,4,20],[9,4,20]]})";
    const std::string second = R"({"type": "LineString", "coordinates": [[5,1,30],[5,9,30]]})";
    report_of("?elevation=own", first);
    report_of("?elevation=own&on_crossing=old", second);
    EXPECT_EQ(elevation_at(5, 4), 20.0);
    session = make_session();
    report_of("?elevation=own", first);
    report_of("?elevation=own&on_crossing=new", second);
    EXPECT_EQ(elevation_at(5, 4), 30.0);
}

TEST_F(PolygonRoutes, SnapWhatIsNear) {
    const std::string line = R"({"type": "LineString", "coordinates": [[0.25,0.125],[7,3]]})";
    report_of("", line);
    const std::size_t exact = vertices();
    EXPECT_FALSE(std::isnan(elevation_at(0.25, 0.125)));
    session = make_session();
    report_of("?snap=0.5", line);
    EXPECT_LT(vertices(), exact) << "the corner took the line's first place";
}

TEST_F(PolygonRoutes, ImproveAsFarAsAllowed) {
    for (const std::string query : {"?improve=none", "?improve=strict", "?improve=paper"})
        EXPECT_EQ(cut(query, kParcel).status, 200) << query;
    const json report = report_of("?improve=bounded&max_deviation=0.125",
                                  R"({"type": "LineString", "coordinates": [[1,7],[8,2.5]]})");
    EXPECT_LE(report["polygons"][0]["max_vertical_deviation"], 0.125);
}

TEST_F(PolygonRoutes, CountAnglesWhereTheyAreAskedFor) {
    const json dry = report_of("?angles=true&dry_run=true", kParcel);
    EXPECT_FALSE(report_of("?dry_run=true", kParcel).contains("smallest_angles"));
    const auto triangles = [&] {
        return json::parse(ask("GET", session).body)["triangles"].get<std::int64_t>();
    };
    const auto sum = [](const json& steps) {
        std::int64_t all = 0;
        for (const json& count : steps)
            all += count.get<std::int64_t>();
        return all;
    };
    const std::int64_t before = triangles();
    const json done = report_of("?angles=true", kParcel);
    EXPECT_EQ(done["smallest_angles"], dry["smallest_angles"]) << "what was promised is there";
    EXPECT_GT(sum(dry["smallest_angles"]["before"]), 0);
    EXPECT_EQ(sum(dry["smallest_angles"]["after"]) - sum(dry["smallest_angles"]["before"]),
              triangles() - before);
    EXPECT_FALSE(json::parse(ask("GET", session + "/history/2").body).contains("smallest_angles"));
}

TEST_F(PolygonRoutes, CountNoAnglesBesideAMesh) {
    for (const char* type :
         {"model/gltf-binary", "model/gltf+json", "application/vnd.tinsmith.delta"}) {
        const Response refused =
            post(session + "/polygons?angles=true", kParcel, {{"accept", type}});
        EXPECT_EQ(refused.status, 400) << type;
        EXPECT_EQ(told(refused), "invalid-parameter") << type;
    }
    EXPECT_EQ(version_of(session), 1);
}

TEST_F(PolygonRoutes, LockAndWindAsAsked) {
    const json report = report_of("?lock=true&winding=nonzero", kParcel);
    EXPECT_EQ(report["totals"]["segments"], 4);
    report_of("?improve=paper", R"({"type": "LineString", "coordinates": [[1,3],[8,3]]})");
}

TEST_F(PolygonRoutes, NameWhatIsOutsideWhereThatIsRefused) {
    const json errors = errors_of("?outside=reject", R"({"type": "FeatureCollection", "features": [
        {"type": "Feature", "geometry": {"type": "Polygon",
                                         "coordinates": [[[8,2],[14,2],[14,4],[8,4],[8,2]]]}},
        {"type": "Feature", "geometry": {"type": "MultiPoint", "coordinates": [[1,1],[20,21]]}},
        {"type": "Feature", "geometry": {"type": "LineString",
                                         "coordinates": [[5,5],[5,12]]}}]})",
                                  422);
    ASSERT_EQ(errors.size(), 3U);
    EXPECT_EQ(errors[0]["code"], "LEAVES_MESH");
    EXPECT_EQ(errors[0]["pointer"], "/features/0/geometry/coordinates/0");
    EXPECT_EQ(errors[0]["coordinate"], json::parse("[10.0,2.0]"));
    EXPECT_NE(errors[0]["detail"].get<std::string>().find("x 10.000, y 4.000"), std::string::npos);
    EXPECT_EQ(errors[1]["pointer"], "/features/1/geometry/coordinates/1");
    EXPECT_EQ(errors[1]["coordinate"], json::parse("[20.0,21.0]"));
    EXPECT_EQ(errors[2]["pointer"], "/features/2/geometry/coordinates");
    EXPECT_EQ(errors[2]["coordinate"], json::parse("[5.0,10.0]"));
    const json bare = errors_of(
        "?outside=reject",
        R"({"type": "Polygon", "coordinates": [[[8,2],[14,2],[14,4],[8,4],[8,2]]]})", 422);
    EXPECT_EQ(bare.at(0)["pointer"], "/coordinates/0");
}

TEST_F(PolygonRoutes, TellBothExtentsWhereNothingMeets) {
    const json errors = errors_of("", R"({"type": "LineString",
                                          "coordinates": [[20,30],[40,50.5]]})",
                                  422);
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_EQ(errors[0]["code"], "OUTSIDE_MESH");
    EXPECT_EQ(errors[0]["coordinate"], json::parse("[20.0,30.0]"));
    const std::string detail = errors[0]["detail"];
    EXPECT_NE(detail.find("x 20.000 to 40.000, y 30.000 to 50.500"), std::string::npos) << detail;
    EXPECT_NE(detail.find("x 0.000 to 10.000, y 0.000 to 10.000"), std::string::npos) << detail;
    EXPECT_EQ(detail.find("degrees"), std::string::npos) << detail;
}

TEST_F(PolygonRoutes, SuspectDegrees) {
    session = header(post("/v1/sessions", R"({"mesh": {
        "vertices": [[700000,4000000,0],[700010,4000000,1],[700010,4000010,2]],
        "triangles": [[0,1,2]]}})"),
                     "Location");
    const json errors = errors_of("", R"({"type": "Point", "coordinates": [-84.1,36.3]})", 422);
    EXPECT_NE(errors.at(0)["detail"].get<std::string>().find("degrees"), std::string::npos);
}

TEST_F(PolygonRoutes, ComeBackDraped) {
    report_of("?winding=nonzero", R"({"type": "Feature", "id": "pond", "properties": {"a": 1.50},
        "geometry": {"type": "Polygon", "coordinates": [[[2,2],[6,2],[6,6],[2,6],[2,2]]]}})");
    report_of("", R"({"type": "LineString", "coordinates": [[4,1],[4,9]]})");
    const Response answer = ask("GET", session + "/polygons");
    ASSERT_EQ(answer.status, 200) << answer.body;
    EXPECT_EQ(answer.content_type, "application/geo+json");
    const json list = json::parse(answer.body);
    EXPECT_EQ(list["crs"]["properties"]["name"], "EPSG:32616");
    ASSERT_EQ(list["features"].size(), 2U);
    const json& pond = list["features"][0];
    EXPECT_EQ(pond["id"], "pond");
    EXPECT_EQ(pond["geometry"]["type"], "Polygon");
    EXPECT_EQ(pond["tinsmith"]["id"], "p1");
    EXPECT_EQ(pond["tinsmith"]["winding"], "nonzero");
    EXPECT_NEAR(pond["tinsmith"]["plan_area"].get<double>(), 16.0, 1e-9);
    EXPECT_GT(pond["tinsmith"]["surface_area"], 16.0);
    EXPECT_GE(pond["tinsmith"]["triangles"], 4);
    const json& ring = pond["geometry"]["coordinates"][0];
    EXPECT_EQ(ring.front(), ring.back());
    for (const json& position : ring)
        EXPECT_EQ(position[2], elevation_at(position[0], position[1])) << position;
    EXPECT_EQ(std::count_if(ring.begin(), ring.end(),
                            [](const json& position) { return position[0] == 4.0; }),
              2)
        << "where the later line split it: " << ring;
    EXPECT_EQ(list["features"][1]["geometry"]["type"], "LineString");
    EXPECT_FALSE(list["features"][1]["tinsmith"].contains("plan_area"));
    EXPECT_EQ(report_of("?dry_run=true", answer.body)["polygons"].size(), 2U) << "it can be sent";
}

TEST_F(PolygonRoutes, ComeBackOneByOne) {
    report_of("", kParcel);
    const Response one = ask("GET", session + "/polygons/p1", {{"accept", "application/json"}});
    ASSERT_EQ(one.status, 200) << one.body;
    EXPECT_EQ(one.content_type, "application/json");
    EXPECT_EQ(json::parse(one.body)["type"], "Feature");
    EXPECT_EQ(header(ask("GET", session + "/polygons/p1"), "ETag"),
              header(ask("GET", session + "/polygons"), "ETag"));
    EXPECT_NE(header(ask("GET", session + "/polygons"), "ETag"), header(one, "ETag"))
        << "another type, another representation";
    const Response none = ask("GET", session + "/polygons/p2");
    EXPECT_EQ(none.status, 404);
    EXPECT_EQ(told(none), "no-such-polygon");
    EXPECT_EQ(ask("GET", session + "/polygons", {{"accept", "image/png"}}).status, 406);
    EXPECT_EQ(ask("GET", "/v1/sessions/none/polygons").status, 404);
}

TEST_F(PolygonRoutes, ComeBackAsFarAsTheyLieOnTheMesh) {
    report_of("", R"({"type": "Polygon", "coordinates": [[[5,2],[15,2],[15,4],[5,4],[5,2]]]})");
    report_of("",
              R"({"type": "Polygon", "coordinates": [[[-5,-5],[15,-5],[15,15],[-5,15],[-5,-5]]]})");
    const json list = json::parse(ask("GET", session + "/polygons").body)["features"];
    EXPECT_EQ(list[0]["geometry"]["type"], "MultiLineString");
    EXPECT_EQ(list[0]["tinsmith"]["partly_outside"], true);
    EXPECT_NEAR(list[0]["tinsmith"]["plan_area"].get<double>(), 10.0, 1e-9);
    EXPECT_TRUE(list[1]["geometry"].is_null());
    EXPECT_NEAR(list[1]["tinsmith"]["plan_area"].get<double>(), 100.0, 1e-9);
}

TEST_F(PolygonRoutes, WindAsAsked) {
    // Two squares of one polygon over each other, both counter-clockwise.
    const std::string twice = R"({"type": "MultiPolygon", "coordinates": [
        [[[1,1],[5,1],[5,5],[1,5],[1,1]]], [[[3,3],[7,3],[7,7],[3,7],[3,3]]]]})";
    report_of("?winding=evenodd", twice);
    report_of("?winding=nonzero", twice);
    const json list = json::parse(ask("GET", session + "/polygons").body)["features"];
    EXPECT_NEAR(list[0]["tinsmith"]["plan_area"].get<double>(), 24.0, 1e-9);
    EXPECT_NEAR(list[1]["tinsmith"]["plan_area"].get<double>(), 28.0, 1e-9);
    EXPECT_EQ(list[0]["geometry"]["type"], "MultiPolygon");
}

}  // namespace
}  // namespace tinsmith::server
