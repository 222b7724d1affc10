// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "server/edit_making.hpp"
#include "server/reply.hpp"
#include "server/work.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

class EditRoutes : public Handlers {
  protected:
    std::string session = make_session();

    void SetUp() override { ASSERT_EQ(post(session + "/polygons", kParcel).status, 200); }

    Response edit(const json& body, std::vector<NameValue> headers = {},
                  const std::string& query = "") {
        return post(session + "/edits" + query, body.dump(), std::move(headers));
    }
    json done(const json& body) {
        const Response response = edit(body);
        EXPECT_EQ(response.status, 200) << response.body;
        return json::parse(response.body);
    }
    double elevation(double x, double y) {
        const Response response =
            ask("GET", session + "/elevation?x=" + std::to_string(x) + "&y=" + std::to_string(y));
        EXPECT_EQ(response.status, 200) << response.body;
        return json::parse(response.body)["elevation"];
    }
    json mesh() { return json::parse(ask("GET", session + "/mesh.json").body); }
    /// "CODE /pointer" of the only fault, with its status before it.
    static std::string fault(const Response& response) {
        const json body = json::parse(response.body, nullptr, false);
        if (!body.contains("errors") || body["errors"].size() != 1) return response.body;
        const json& error = body["errors"][0];
        return std::to_string(response.status) + " " + error["code"].get<std::string>() + " " +
               error.value("pointer", "");
    }
};

TEST_F(EditRoutes, SetAPadWhoseVolumeIsThatOfItsFrustum) {
    // On a level, so that all is known: a pad of 3 x 3 with its strip inside.
    done({{"operation", "set"}, {"polygon", "p1"}, {"elevation", 0}, {"taper", 1.5}});
    const Response forked = ask("POST", session + "/fork");
    const std::string before = json::parse(forked.body)["id"];
    const json report =
        done({{"operation", "set"}, {"polygon", "p1"}, {"elevation", 2}, {"rim", 0.25}});
    const double frustum = 2.0 / 3 * (9 + 6.25 + std::sqrt(9 * 6.25));
    EXPECT_NEAR(report["fill"].get<double>(), frustum, 1e-12);
    EXPECT_EQ(report["cut"], 0.0);
    EXPECT_EQ(report["max_elevation_change"], 2.0);
    EXPECT_EQ(report["rim"], 0.25);
    EXPECT_EQ(report["border"], "old");
    EXPECT_EQ(elevation(2.25, 2.25), 2.0);
    EXPECT_EQ(elevation(3.5, 3.5), 2.0);
    EXPECT_EQ(elevation(2, 3), 0.0);
    EXPECT_NEAR(elevation(2.125, 3.5), 1.0, 1e-15);
    const json volume = json::parse(
        post(session + "/volume", json{{"against", {{"session", before}}}}.dump()).body);
    EXPECT_NEAR(volume["cut"].get<double>(), frustum, 1e-12);
    EXPECT_EQ(volume["fill"], 0.0);
}

TEST_F(EditRoutes, AnswerLikePolygonsDo) {
    const json body{{"operation", "offset"}, {"polygon", "p1"}, {"by", 1}};
    const Response response = edit(body);
    EXPECT_EQ(response.content_type, kJson);
    const json report = json::parse(response.body);
    EXPECT_EQ(report["version"], 3);
    EXPECT_EQ(report["dry_run"], false);
    EXPECT_EQ(report["operation"], "offset");
    EXPECT_EQ(report["polygon"], "p1");
    EXPECT_EQ(report["rim"], 0.05);
    EXPECT_GT(report["vertices_moved"], 0);
    EXPECT_GT(report["triangles_affected"], 0);
    for (const char* stage : {"locate", "integrate", "improve", "apply"})
        EXPECT_GE(report["time_ms"][stage].get<double>(), 0.0);
    EXPECT_EQ(header(response, "Link"), "<" + session + "/history/3>; rel=\"describedby\"");
    EXPECT_EQ(ask("GET", session + "/history/3").body, response.body);
    const json history = json::parse(ask("GET", session + "/history").body);
    EXPECT_EQ(history["changes"].back()["change"], "edit");
    EXPECT_EQ(history["changes"].back()["polygons"], json{"p1"});
    EXPECT_EQ(edit(body, {{"accept", "model/gltf-binary"}}).body.substr(0, 4), "glTF");
    const Response plain = edit(body, {{"accept", "model/gltf-binary"}}, "?compression=none");
    EXPECT_TRUE(plain.body == ask("GET", session + "/mesh.glb?compression=none").body);
    EXPECT_EQ(edit(body, {}, "?compression=none").status, 400);
    EXPECT_EQ(edit(body, {{"accept", "application/vnd.tinsmith.delta"}}).body.substr(0, 4), "TNDL");
    EXPECT_EQ(edit(body, {{"accept", "image/png"}}).status, 406);
    EXPECT_EQ(version_of(session), 6);
}

TEST_F(EditRoutes, ADryRunTellsTheSameAndChangesNothing) {
    const json before = mesh();
    for (const json& body : {json{{"operation", "remove"}, {"polygon", "p1"}},
                             json{{"operation", "smooth"}, {"polygon", "p1"}, {"passes", 2}},
                             json{{"operation", "offset"}, {"polygon", "p1"}, {"by", 3}}}) {
        json dry = json::parse(edit(body, {}, "?dry_run=true").body);
        EXPECT_EQ(dry["dry_run"], true);
        EXPECT_EQ(dry["version"], 2);
        EXPECT_EQ(mesh(), before);
        json real = done(body);
        for (json* each : {&dry, &real})
            for (const char* name : {"dry_run", "version", "time_ms"})
                each->erase(name);
        EXPECT_EQ(dry, real);
        EXPECT_EQ(ask("POST", session + "/undo").status, 200);
        EXPECT_EQ(mesh(), before);
        ask("DELETE", session);
        session = make_session();
        SetUp();
    }
    EXPECT_EQ(edit({{"operation", "keep"}, {"polygon", "p1"}}, {}, "?dry_run=maybe").status, 400);
    EXPECT_EQ(edit({{"operation", "keep"}, {"polygon", "p1"}},
                   {{"accept", "application/vnd.tinsmith.delta"}}, "?dry_run=true")
                  .status,
              400);
}

TEST_F(EditRoutes, RefuseWhatCannotBeDoneByName) {
    const auto set = [&](const std::string& polygon, json more) {
        more.update({{"operation", "set"}, {"polygon", polygon}, {"elevation", 1}});
        return fault(edit(more));
    };
    EXPECT_EQ(set("p7", json::object()), "404 NO_SUCH_POLYGON /polygon");
    EXPECT_EQ(set("p1", {{"rim", 1.6}}), "422 RIM_TOO_WIDE /rim");
    EXPECT_EQ(set("p1", {{"rim", 1e-15}}), "422 RIM_TOO_SMALL /rim");
    EXPECT_EQ(set("p1", {{"taper", 1e-15}}), "422 TAPER_TOO_SMALL /taper");
    EXPECT_NE(edit({{"operation", "set"}, {"polygon", "p1"}, {"elevation", 1}, {"rim", 1.6}})
                  .body.find("give a rim of 1.49 at most"),
              std::string::npos);
    post(session + "/polygons", R"({"type": "LineString", "coordinates": [[1,1],[9,8]]})");
    EXPECT_EQ(set("p2", json::object()), "422 NO_INSIDE /polygon");
    post(session + "/polygons?snap=0.2",
         R"({"type": "Polygon", "coordinates": [[[6,6],[9,6],[9,9],[6,6]]]})");
    EXPECT_EQ(set("p3", {{"rim", 0.1}}), "422 RIM_TOO_SMALL /rim");
    EXPECT_EQ(set("p3", {{"rim", 0.3}}).substr(0, 3), "{\"s") << "done";
    // Thinner than the default is wide.
    post(session + "/polygons",
         R"({"type": "Polygon", "coordinates": [[[1,8],[2,8],[2,8.02],[1,8.02],[1,8]]]})");
    EXPECT_EQ(set("p4", json::object()), "422 RIM_TOO_WIDE ");
    EXPECT_EQ(set("p4", {{"border", "new"}}).substr(0, 3), "{\"s");
    // All of it.
    post(session + "/polygons",
         R"({"type": "Polygon", "coordinates": [[[-1,-1],[11,-1],[11,11],[-1,11],[-1,-1]]]})");
    EXPECT_EQ(fault(edit({{"operation", "remove"}, {"polygon", "p5"}})),
              "422 NOTHING_LEFT /polygon");
    EXPECT_EQ(fault(edit({{"operation", "keep"}, {"polygon", "p5"}})).substr(0, 3), "{\"s");
    EXPECT_EQ(post(session + "/edits", "{").status, 400);
    EXPECT_EQ(ask("POST", session + "/edits", {{"content-type", "text/csv"}}, "x").status, 415);
}

TEST_F(EditRoutes, HonourIfMatchAndKeys) {
    const json body{{"operation", "offset"}, {"polygon", "p1"}, {"by", 1}};
    const std::string now = header(ask("GET", session), "ETag");
    const Response first = edit(body, {{"if-match", now}, {"idempotency-key", "a"}});
    EXPECT_EQ(first.status, 200);
    EXPECT_EQ(edit(body, {{"if-match", now}}).status, 412);
    const Response again = edit(body, {{"if-match", now}, {"idempotency-key", "a"}});
    EXPECT_EQ(again.body, first.body);
    EXPECT_EQ(header(again, "Idempotency-Replayed"), "true");
    EXPECT_EQ(version_of(session), 3);
}

/// A ring that takes long, as its lines cross one another everywhere.
TEST_F(EditRoutes, EndAtTheDeadlineWhileTheirRingIsDrawn) {
    json points = json::array();
    constexpr int kSpikes = 1500;
    for (int i = 0; i <= 2 * kSpikes; ++i) {
        const double radius = i % 2 == 0 ? 3 : 2.7, angle = M_PI * (i % (2 * kSpikes)) / kSpikes;
        points.push_back({5 + radius * std::cos(angle), 5 + radius * std::sin(angle)});
    }
    const json star{{"type", "Polygon"}, {"coordinates", json::array({points})}};
    ASSERT_EQ(post(session + "/polygons", star.dump()).status, 200);
    Limits limits = services.limits;
    limits.max_edit_seconds = 0.1;
    for (const char* strip : {"rim", "taper"}) {
        const json body{{"operation", "set"}, {"polygon", "p2"}, {"elevation", 1}, {strip, 0.3}};
        const auto asked = api::read_edit_request(body.dump(), services.read_limits());
        ASSERT_TRUE(asked);
        const auto made = make_edit(*services.sessions.find(session.substr(13), {}), *asked, limits,
                                    services.stopping);
        ASSERT_TRUE(std::holds_alternative<NoEdit>(made));
        const auto& no = std::get<NoEdit>(made);
        ASSERT_TRUE(std::holds_alternative<core::Errors>(no));
        EXPECT_EQ(std::get<core::Errors>(no)[0].code, core::ErrorCode::Cancelled);
    }
}

TEST_F(EditRoutes, ADryRunAsksForTheMemoryOfItsCopy) {
    const json body{{"operation", "offset"}, {"polygon", "p1"}, {"by", 1}};
    auto all = services.sessions.borrow(services.limits.max_memory_bytes -
                                        services.sessions.memory_bytes());
    ASSERT_TRUE(all);
    EXPECT_EQ(told(edit(body, {}, "?dry_run=true")), "out-of-memory");
    all.reset();
    EXPECT_EQ(edit(body, {}, "?dry_run=true").status, 200);
}

TEST_F(EditRoutes, ShowRealProgress) {
    for (const char* query : {"", "?dry_run=true"}) {
        std::vector<double> told_of;
        Work work([&told_of](double progress) { told_of.push_back(progress); });
        const WorkScope scope(work);
        const json body{{"operation", "smooth"}, {"polygon", "p1"}, {"passes", 50}};
        EXPECT_EQ(edit(body, {}, query).status, 200);
        EXPECT_GT(told_of.size(), 20U);
    }
}

TEST_F(EditRoutes, GoWithTheirPolygonOrKeepIt) {
    const json before = mesh();
    post(session + "/polygons",
         R"({"type": "Polygon", "coordinates": [[[4,4],[8,4],[8,8],[4,8],[4,4]]]})");
    done({{"operation", "remove"}, {"polygon", "p1"}});
    done({{"operation", "offset"}, {"polygon", "p2"}, {"by", 1}});
    const json with_both = mesh();
    const Response refused = ask("DELETE", session + "/polygons/p1");
    EXPECT_EQ(refused.status, 409);
    EXPECT_NE(refused.body.find("these versions name the polygon: 4."), std::string::npos);
    EXPECT_EQ(ask("DELETE", session + "/polygons/p1?cascade=true").status, 200);
    // As if p1 and its hole had never been; the other edit is made again.
    EXPECT_NEAR(elevation(3, 3), 0.6, 1e-12) << "there is ground again";
    const json features = json::parse(ask("GET", session + "/polygons").body)["features"];
    ASSERT_EQ(features.size(), 1U);
    EXPECT_NEAR(features[0]["tinsmith"]["plan_area"].get<double>(), 16.0, 1e-12);
    ask("POST", session + "/undo");
    EXPECT_EQ(mesh(), with_both);
    ask("POST", session + "/redo");
    ask("DELETE", session + "/polygons/p2?cascade=true");
    EXPECT_EQ(mesh()["vertices"].size(), 4U);
    EXPECT_NE(before["vertices"].size(), 4U);
}

TEST_F(EditRoutes, PolygonsCutByAHoleTellWhatIsLeftOfThem) {
    post(session + "/polygons",
         R"({"type": "Polygon", "coordinates": [[[4,1],[8,1],[8,4],[4,4],[4,1]]]})");
    done({{"operation", "remove"}, {"polygon", "p1"}});
    json cut = json::parse(ask("GET", session + "/polygons/p2").body);
    EXPECT_NEAR(cut["tinsmith"]["plan_area"].get<double>(), 12 - 2, 1e-12);
    EXPECT_EQ(cut["tinsmith"]["partly_outside"], true);
    EXPECT_EQ(cut["geometry"]["type"], "MultiLineString");
    const json hole = json::parse(ask("GET", session + "/polygons/p1").body);
    EXPECT_EQ(hole["tinsmith"]["triangles"], 0);
    EXPECT_EQ(hole["geometry"]["type"], "Polygon") << "all of its border is there";
    // Nothing of p1 is left where p2 is kept, but for the border that they share.
    done({{"operation", "keep"}, {"polygon", "p2"}});
    cut = json::parse(ask("GET", session + "/polygons/p2").body);
    EXPECT_NEAR(cut["tinsmith"]["plan_area"].get<double>(), 10, 1e-12);
    EXPECT_EQ(json::parse(ask("GET", session + "/polygons/p1").body)["tinsmith"]["triangles"], 0);
    EXPECT_EQ(json::parse(ask("GET", session).body)["bounds"][0], 4.0);
    // And what is cut in later is told rightly, too.
    post(session + "/polygons",
         R"({"type": "Polygon", "coordinates": [[[3,2],[7,2],[7,3],[3,3],[3,2]]]})");
    const json later = json::parse(ask("GET", session + "/polygons/p3").body);
    EXPECT_NEAR(later["tinsmith"]["plan_area"].get<double>(), 2, 1e-12);
}

}  // namespace
}  // namespace tinsmith::server
