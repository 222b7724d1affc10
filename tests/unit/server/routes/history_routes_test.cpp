// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

constexpr const char* kTwo = R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"n": 1}, "geometry": {"type": "Polygon",
     "coordinates": [[[1,1],[4,1],[4,4],[1,1]]]}},
    {"type": "Feature", "properties": {"n": 2}, "geometry": {"type": "Polygon",
     "coordinates": [[[3,2],[7,2],[7,6],[3,2]]]}}]})";

class HistoryRoutes : public Handlers {
  protected:
    std::string session = make_session();

    std::string mesh() { return ask("GET", session + "/mesh.json").body; }
    json history() { return json::parse(ask("GET", session + "/history").body); }
};

TEST_F(HistoryRoutes, UndoAndRedo) {
    const std::string before = mesh();
    post(session + "/polygons", kParcel);
    const std::string after = mesh();
    const Response undone = ask("POST", session + "/undo");
    ASSERT_EQ(undone.status, 200) << undone.body;
    EXPECT_EQ(header(undone, "Link"), "<" + session + "/history/3>; rel=\"describedby\"");
    EXPECT_EQ(header(undone, "ETag"), header(ask("GET", session), "ETag"));
    const json told_of = json::parse(undone.body);
    EXPECT_EQ(told_of["version"], 3);
    EXPECT_EQ(told_of["change"], "undo");
    EXPECT_EQ(told_of["of"], 2);
    EXPECT_EQ(told_of["polygons"], json::parse(R"(["p1"])"));
    EXPECT_EQ(told_of["triangles"], 2);
    EXPECT_EQ(mesh(), before);
    EXPECT_EQ(json::parse(ask("POST", session + "/redo").body)["change"], "redo");
    EXPECT_EQ(mesh(), after);
    EXPECT_EQ(version_of(session), 4);
}

TEST_F(HistoryRoutes, SayWhenThereIsNothingToDo) {
    for (const char* what : {"undo", "redo"}) {
        const Response refused = ask("POST", session + "/" + what);
        EXPECT_EQ(refused.status, 409);
        EXPECT_EQ(told(refused), std::string("nothing-to-") + what);
    }
    EXPECT_EQ(version_of(session), 1);
}

TEST_F(HistoryRoutes, HonourIfMatch) {
    const std::string old = header(ask("GET", session), "ETag");
    post(session + "/polygons", kParcel);
    for (const auto& [method, path] :
         std::vector<NameValue>{{"POST", "/undo"}, {"POST", "/redo"}, {"DELETE", "/polygons/p1"}}) {
        const Response late = ask(method, session + path, {{"if-match", old}});
        EXPECT_EQ(late.status, 412) << path;
        EXPECT_EQ(header(late, "ETag"), header(ask("GET", session), "ETag"));
    }
    const std::string now = header(ask("GET", session), "ETag");
    EXPECT_EQ(ask("POST", session + "/undo", {{"if-match", now}}).status, 200);
}

TEST_F(HistoryRoutes, KeepTheReportOfEachRequest) {
    const Response made = post(session + "/polygons", kTwo);
    EXPECT_EQ(header(made, "Link"), "<" + session + "/history/2>; rel=\"describedby\"");
    EXPECT_EQ(ask("GET", session + "/history/2").body, made.body);
    ask("DELETE", session + "/polygons/p1");
    EXPECT_EQ(ask("GET", session + "/history/2").body, made.body) << "what was told stays told";
    EXPECT_EQ(json::parse(ask("GET", session + "/history/3").body)["change"], "polygon_removed");
    EXPECT_EQ(json::parse(ask("GET", session + "/history/1").body)["change"], "created");
    for (const char* none : {"4", "0", "x", "-1"})
        EXPECT_EQ(told(ask("GET", session + "/history/" + none)), "no-such-version") << none;
    EXPECT_EQ(header(post(session + "/polygons?dry_run=true", kTwo), "Link"), "");
}

TEST_F(HistoryRoutes, ListHowEachVersionCameAbout) {
    post(session + "/polygons", kTwo);
    ask("POST", session + "/undo");
    const json list = history();
    EXPECT_EQ(list["version"], 3);
    EXPECT_EQ(list["oldest"], 1);
    EXPECT_EQ(list["undo"], nullptr);
    EXPECT_EQ(list["redo"], 2);
    ASSERT_EQ(list["changes"].size(), 3U);
    EXPECT_EQ(list["changes"][1]["change"], "polygons");
    EXPECT_EQ(list["changes"][1]["polygons"], json::parse(R"(["p1","p2"])"));
    EXPECT_EQ(list["changes"][2]["of"], 2);
}

TEST_F(HistoryRoutes, TakeAPolygonOut) {
    post(session + "/polygons", kTwo);
    post(session + "/polygons", kParcel);
    const Response gone = ask("DELETE", session + "/polygons/p1");
    ASSERT_EQ(gone.status, 200) << gone.body;
    EXPECT_EQ(json::parse(gone.body)["polygons"], json::parse(R"(["p1"])"));
    const std::string left = mesh();
    EXPECT_EQ(ask("GET", session + "/polygons/p1").status, 404);
    EXPECT_EQ(ask("GET", session + "/polygons/p2").status, 200);
    EXPECT_EQ(told(ask("DELETE", session + "/polygons/p1")), "no-such-polygon");
    json second = json::parse(kTwo);
    second["features"].erase(0);
    session = make_session();
    post(session + "/polygons", second.dump());
    post(session + "/polygons", kParcel);
    EXPECT_EQ(mesh(), left);
}

TEST_F(HistoryRoutes, KnowCascade) {
    post(session + "/polygons", kTwo);
    EXPECT_EQ(told(ask("DELETE", session + "/polygons/p1?cascade=1")), "INVALID_VALUE");
    EXPECT_EQ(told(ask("DELETE", session + "/polygons/p1?force=true")), "UNKNOWN_PARAMETER");
    EXPECT_EQ(ask("DELETE", session + "/polygons/p1?cascade=true").status, 200);
    EXPECT_EQ(ask("DELETE", session + "/polygons/p2?cascade=false").status, 200);
}

TEST_F(HistoryRoutes, SayWhichOperationCannotBeDoneAgain) {
    post(session + "/polygons", R"({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": null, "geometry": {"type": "Point", "coordinates": [2,3]}},
        {"type": "Feature", "properties": null, "geometry": {"type": "Point", "coordinates": [90,90]}}
        ]})");
    const std::string before = mesh();
    const Response refused = ask("DELETE", session + "/polygons/p1");
    EXPECT_EQ(refused.status, 409);
    const json problem = json::parse(refused.body);
    EXPECT_EQ(problem["type"], "urn:tinsmith:problem:replay-failed");
    EXPECT_NE(refused.body.find("version 2"), std::string::npos);
    EXPECT_EQ(problem["errors"][0]["code"], "OUTSIDE_MESH");
    EXPECT_EQ(mesh(), before);
    EXPECT_EQ(version_of(session), 2);
}

TEST_F(HistoryRoutes, RefuseBodiesAndOtherMediaTypes) {
    EXPECT_EQ(told(post(session + "/undo", "{}")), "bad-request");
    EXPECT_EQ(ask("POST", session + "/undo", {{"accept", "image/png"}}).status, 406);
}

}  // namespace
}  // namespace tinsmith::server
