// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

/// The square rises by 0.1 x + 0.1 y below its diagonal, by -0.1 x + 0.3 y above it.
class Questions : public Handlers {
  protected:
    std::string session = make_session();

    json good(const Response& response) {
        EXPECT_EQ(response.status, 200) << response.body;
        EXPECT_EQ(response.content_type, "application/json");
        EXPECT_EQ(header(response, "ETag"), header(ask("GET", session), "ETag"));
        const auto body = json::parse(response.body, nullptr, false);
        if (!body.is_object()) return json::object();
        EXPECT_EQ("/v1/sessions/" + body["session"].get<std::string>(), session);
        EXPECT_EQ(body["version"], version_of(session));
        EXPECT_EQ(body["unit"], "metre");
        return body;
    }
    json volume(const std::string& body) { return good(post(session + "/volume", body)); }

    /// The pointers or parameters in errors[].
    static std::string places(const Response& response) {
        std::string list;
        const auto body = json::parse(response.body);
        for (const auto& error : body["errors"]) {
            if (!list.empty()) list += " ";
            list += error.contains("pointer") ? error["pointer"].get<std::string>()
                                              : error.value("parameter", "-");
        }
        return list;
    }
};

TEST_F(Questions, ElevationAtOnePoint) {
    const auto found = good(ask("GET", session + "/elevation?x=8&y=3"));
    EXPECT_DOUBLE_EQ(found["elevation"].get<double>(), 1.1);
    EXPECT_EQ(found["triangle"], 0);
    EXPECT_EQ(found["polygons"], json::array());
    ASSERT_EQ(post(session + "/polygons", kParcel).status, 200);
    EXPECT_EQ(good(ask("GET", session + "/elevation?x=3&y=3.5"))["polygons"], json({"p1"}));
    EXPECT_EQ(good(ask("GET", session + "/elevation?x=8&y=3"))["polygons"], json::array());

    const Response outside = ask("GET", session + "/elevation?x=-1&y=3");
    EXPECT_EQ(outside.status, 404);
    EXPECT_EQ(told(outside), "outside-mesh");
    const Response broken = ask("GET", session + "/elevation?x=1e400");
    EXPECT_EQ(broken.status, 400);
    EXPECT_EQ(told(broken), "INVALID_OPTION OPTION_MISSING");
    EXPECT_EQ(places(broken), "x y");
    EXPECT_EQ(ask("GET", session + "/elevation?x=1&y=2&z=3").status, 400);
    EXPECT_EQ(told(ask("GET", "/v1/sessions/none/elevation?x=1&y=2")), "no-such-session");
}

TEST_F(Questions, ElevationAtManyPoints) {
    const auto found = good(post(session + "/elevation", R"({"points": [[8,3],[-1,3],[10,10]]})"));
    ASSERT_EQ(found["points"].size(), 3U);
    EXPECT_DOUBLE_EQ(found["points"][0]["elevation"].get<double>(), 1.1);
    EXPECT_EQ(found["points"][1], json::parse(R"({"elevation": null, "triangle": null,
                                                  "reason": "outside-mesh"})"));
    EXPECT_EQ(found["points"][2]["elevation"], 2.0);
    EXPECT_EQ(good(post(session + "/elevation", R"({"points": []})"))["points"].size(), 0U);

    const Response broken =
        post(session + "/elevation", R"({"points": [[1],[1,2],["a",3],[1,1e20]], "z": 1})");
    EXPECT_EQ(broken.status, 422);
    EXPECT_EQ(told(broken), "WRONG_LENGTH WRONG_TYPE COORDINATE_OUT_OF_RANGE MEMBER_UNKNOWN");
    EXPECT_EQ(places(broken), "/points/0 /points/2/0 /points/3/1 /z");
    EXPECT_EQ(post(session + "/elevation", "{").status, 400);
    EXPECT_EQ(ask("POST", session + "/elevation", {{"content-type", "text/csv"}}, "1,2").status,
              415);
}

TEST_F(Questions, BoundTheNumberOfPoints) {
    std::string body = R"({"points":[)";
    for (int i = 0; i < 100'001; ++i)
        body += i == 0 ? "[1,1]" : ",[1,1]";
    const Response refused = post(session + "/elevation", body + "]}");
    EXPECT_EQ(refused.status, 413);
    EXPECT_EQ(told(refused), "TOO_MANY_POINTS");
}

TEST_F(Questions, ProfileAlongALine) {
    const std::string line = R"({"type": "LineString", "coordinates": [[-5,5],[8,5],[8,9]]})";
    const auto found = good(post(session + "/profile", line));
    EXPECT_EQ(found["length"], 17.0);
    ASSERT_EQ(found["stretches"].size(), 1U);
    const auto points = found["stretches"][0]["points"];
    ASSERT_EQ(points.size(), 5U);
    EXPECT_EQ(found["crossings"], 3);
    EXPECT_EQ(points[0], json::parse(R"({"distance": 5.0, "position": [0.0,5.0], "elevation": 1.5,
                                        "triangle": 1, "at": "edge"})"));
    EXPECT_EQ(points[1]["distance"], 10.0);
    EXPECT_EQ(points[1]["elevation"], 1.0);
    EXPECT_EQ(points[2]["at"], "input");
    EXPECT_EQ(points[3]["position"], json({8.0, 8.0}));
    EXPECT_DOUBLE_EQ(points[4]["elevation"].get<double>(), 1.9);
    EXPECT_EQ(good(post(session + "/profile",
                        R"({"type": "Feature", "properties": {}, "geometry": )" + line + "}"))
                  .dump(),
              found.dump());
    EXPECT_EQ(good(post(session + "/profile",
                        R"({"type": "LineString", "coordinates": [[-5,5],[-8,5]]})"))["stretches"],
              json::array());
}

TEST_F(Questions, RefuseWhatIsNoLine) {
    const Response area = post(session + "/profile", kParcel);
    EXPECT_EQ(area.status, 422);
    EXPECT_EQ(told(area), "GEOJSON_TYPE");
    EXPECT_EQ(
        told(post(session + "/profile", R"({"type": "LineString", "coordinates": [[1,5],[1,5]]})")),
        "LINE_TOO_SHORT");
    const Response claimed = post(session + "/profile", R"({"type": "LineString",
        "coordinates": [[1,5],[8,5]], "crs": {"type": "name", "properties": {"name": "EPSG:999999"}}})");
    EXPECT_EQ(told(claimed), "CRS_UNKNOWN");
    const Response option = post(session + "/profile", R"({"type": "LineString",
        "coordinates": [[1,5],[8,5]], "tinsmith": {"snap": 1}})");
    EXPECT_EQ(told(option), "UNKNOWN_OPTION");
    EXPECT_EQ(places(option), "/tinsmith/snap");
}

TEST_F(Questions, VolumeAgainstALevelAndPlanes) {
    const auto all = volume(R"({"against": {"elevation": 0}})");
    EXPECT_DOUBLE_EQ(all["cut"].get<double>(), 50.0 + 250.0 / 3.0);
    EXPECT_EQ(all["fill"], 0.0);
    EXPECT_EQ(all["area"], 100.0);
    EXPECT_EQ(all["area_left_out"], 0.0);
    EXPECT_EQ(all["polygon"], nullptr);
    EXPECT_EQ(all["against"], json({{"elevation", 0.0}}));

    const auto part = volume(R"({"polygon": {"type": "Polygon",
        "coordinates": [[[6,1],[8,1],[8,3],[6,3],[6,1]]]}, "against": {"elevation": 2}})");
    EXPECT_NEAR(part["fill"].get<double>(), 4 * (2 - 0.9), 1e-12);
    EXPECT_EQ(part["cut"], 0.0);
    const auto plane = volume(R"({"polygon": {"type": "Polygon",
        "coordinates": [[[6,1],[18,1],[18,3],[6,3],[6,1]]]},
        "against": {"plane": [[0,0,-1],[10,0,0],[0,10,0]]}})");
    EXPECT_NEAR(plane["cut"].get<double>(), 8.0, 1e-12);
    EXPECT_EQ(plane["against"]["plane"]["point"], json({0.0, 0.0, -1.0}));
    EXPECT_DOUBLE_EQ(plane["against"]["plane"]["per_x"].get<double>(), 0.1);
    EXPECT_NEAR(plane["area_left_out"].get<double>(), 16.0, 1e-12);
    const auto slope = volume(R"({"polygon": {"type": "Polygon",
        "coordinates": [[[6,1],[8,1],[8,3],[6,3],[6,1]]]},
        "against": {"slope": 0.1, "azimuth": 90, "point": [0,2,0]}})");
    EXPECT_NEAR(slope["cut"].get<double>(), 4 * 0.2, 1e-12);
    EXPECT_EQ(version_of(session), 1) << "a question changes nothing";
}

TEST_F(Questions, VolumeInAPolygonOfTheSession) {
    ASSERT_EQ(post(session + "/polygons", kParcel).status, 200);
    const auto own = volume(R"({"polygon": "p1", "against": {"elevation": 0}})");
    EXPECT_EQ(own["polygon"], "p1");
    EXPECT_NEAR(own["area"].get<double>(), 9.0, 1e-12);
    EXPECT_EQ(own["area_left_out"], 0.0);
    const auto drawn =
        volume(std::string(R"({"polygon": )") + kParcel + R"(, "against": {"elevation": 0}})");
    EXPECT_NEAR(own["cut"].get<double>(), drawn["cut"].get<double>(), 1e-12);

    const Response none =
        post(session + "/volume", R"({"polygon": "p9", "against": {"elevation": 0}})");
    EXPECT_EQ(none.status, 404);
    EXPECT_EQ(told(none), "NO_SUCH_POLYGON");
    ASSERT_EQ(
        post(session + "/polygons", R"({"type":"LineString","coordinates":[[1,1],[9,2]]})").status,
        200);
    EXPECT_EQ(told(post(session + "/volume", R"({"polygon": "p2", "against": {"elevation": 0}})")),
              "NO_INSIDE");
}

TEST_F(Questions, VolumeAgainstAnotherSession) {
    const std::string raised =
        R"({"name": "Raised", "crs": "EPSG:32616", "mesh": {
        "vertices": [[0,0,5],[5,0,5],[5,10,5],[0,10,5]], "triangles": [[0,1,2],[0,2,3]]}})";
    const std::string other = json::parse(post("/v1/sessions", raised).body)["id"];
    const auto found = volume(R"({"against": {"session": ")" + other + R"("}})");
    EXPECT_EQ(found["cut"], 0.0);
    EXPECT_EQ(found["area"], 50.0);
    EXPECT_EQ(found["area_left_out"], 50.0);
    EXPECT_EQ(found["against"], json({{"session", other}, {"version", 1}}));
    const std::string ours = session.substr(std::string("/v1/sessions/").size());
    const auto back = json::parse(
        post("/v1/sessions/" + other + "/volume", R"({"against": {"session": ")" + ours + R"("}})")
            .body);
    EXPECT_DOUBLE_EQ(back["cut"].get<double>(), found["fill"].get<double>());
    EXPECT_EQ(back["area_left_out"], 50.0) << "whichever of them covers it";
    const auto itself = volume(R"({"against": {"session": ")" + ours + R"("}})");
    EXPECT_EQ(itself["cut"], 0.0);
    EXPECT_EQ(itself["fill"], 0.0);
    EXPECT_EQ(itself["area"], 100.0);

    const Response none = post(session + "/volume", R"({"against": {"session": "none"}})");
    EXPECT_EQ(none.status, 404);
    EXPECT_EQ(told(none), "NO_SUCH_SESSION");
    EXPECT_EQ(places(none), "/against/session");
}

TEST_F(Questions, RefuseAVolumeInAnotherSystem) {
    for (const char* system : {R"("crs": {"type": "name", "properties": {"name": "EPSG:4326"}})",
                               R"("coordRefSys": "EPSG:4326")"}) {
        const Response refused =
            post(make_session() + "/volume",
                 std::string(R"({"against": {"elevation": 0}, "polygon": {"type": "Polygon", )") +
                     system + R"(, "coordinates": [[[1,1],[2,1],[2,2],[1,1]]]}})");
        EXPECT_EQ(refused.status, 422) << refused.body;
        EXPECT_EQ(told(refused), "CRS_NOT_TAKEN");
    }
}

TEST_F(Questions, RefuseVolumesWithAllFaultsAtOnce) {
    const auto codes = [&](const std::string& body) {
        const Response refused = post(session + "/volume", body);
        EXPECT_EQ(refused.status, 422) << refused.body;
        return told(refused) + " @ " + places(refused);
    };
    EXPECT_EQ(codes("{}"), "MEMBER_MISSING @ -");
    EXPECT_EQ(codes(R"({"against": {}})"), "MEMBER_MISSING @ /against");
    EXPECT_EQ(codes(R"({"against": {"elevation": 1, "session": "x"}})"),
              "CONTRADICTION @ /against");
    EXPECT_EQ(codes(R"({"against": {"slope": 1}})"),
              "MEMBER_MISSING MEMBER_MISSING @ /against /against");
    EXPECT_EQ(codes(R"({"against": {"plane": [[0,0,0],[1,1,0]]}})"),
              "WRONG_LENGTH @ /against/plane");
    EXPECT_EQ(codes(R"({"against": {"plane": [[0,0,0],[1,1,0],[2,2,5]]}})"),
              "PLANE_UPRIGHT @ /against/plane");
    EXPECT_EQ(codes(R"({"against": {"version": 0}})"), "WRONG_TYPE @ /against/version");
    EXPECT_EQ(codes(R"({"polygon": {"type": "Point", "coordinates": [1,1]},
                        "against": {"elevation": "high", "level": 3}, "grid": 1})"),
              "GEOJSON_TYPE WRONG_TYPE MEMBER_UNKNOWN MEMBER_UNKNOWN @ /polygon/type "
              "/against/elevation /against/level /grid");
    EXPECT_EQ(codes(R"({"polygon": 7, "against": {"elevation": 1}})"), "WRONG_TYPE @ /polygon");
    EXPECT_EQ(codes(R"({"polygon": {"type": "Polygon", "coordinates": [[[1,1],[2,2],[1,1]]]},
                        "against": {"elevation": 1}})")
                  .substr(0, 4),
              "RING");
}

}  // namespace
}  // namespace tinsmith::server
