// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

constexpr const char* kDiagonal = R"({"type": "LineString", "coordinates": [[0,0],[10,10]]})";
constexpr const char* kBorder =
    R"({"type": "Polygon", "coordinates": [[[2,2],[5,2],[5,5],[2,5],[2,2]]]})";

class LockRoutes : public Handlers {
  protected:
    std::string session = make_session();

    Response lock(const std::string& body, const std::string& query = {},
                  std::vector<NameValue> headers = {}, const std::string& method = "PUT") {
        headers.emplace_back("content-type", "application/json");
        return ask(method, session + "/locks" + query, std::move(headers), body);
    }
    Response unlock(const std::string& body) { return lock(body, {}, {}, "DELETE"); }

    json locked() {
        return json::parse(ask("GET", session + "/locks").body)["tinsmith"]["vertices"];
    }
    std::string mesh() { return ask("GET", session + "/mesh.json").body; }
};

TEST_F(LockRoutes, LockAndUnlock) {
    const std::string before = mesh();
    const Response made = lock(kDiagonal);
    ASSERT_EQ(made.status, 200) << made.body;
    EXPECT_EQ(json::parse(made.body), json::parse(R"({"session": ")" + session.substr(13) +
                                                  R"(", "version": 2, "dry_run": false,
        "locked": true, "edges": 1, "changed": 1, "length": 14.142135623730951,
        "without_edge": []})"));
    EXPECT_EQ(header(made, "Link"), "<" + session + "/history/2>; rel=\"describedby\"");
    EXPECT_EQ(header(made, "ETag"), header(ask("GET", session), "ETag"));
    EXPECT_EQ(mesh(), before);
    const Response list = ask("GET", session + "/locks");
    EXPECT_EQ(json::parse(list.body)["geometry"]["coordinates"],
              json::parse("[[[10,10,2],[0,0,0]]]"));
    EXPECT_EQ(locked(), json::parse("[[2,0]]"));
    EXPECT_EQ(ask("GET", session + "/locks", {{"if-none-match", header(list, "ETag")}}).status,
              304);
    EXPECT_EQ(json::parse(lock(kDiagonal).body)["changed"], 0) << "twice is once";
    const Response gone = unlock(kDiagonal);
    EXPECT_EQ(json::parse(gone.body)["locked"], false);
    EXPECT_EQ(json::parse(gone.body)["changed"], 1);
    EXPECT_EQ(locked(), json::array());
    EXPECT_EQ(ask("GET", session + "/history/2").body, made.body) << "what was told stays told";
}

TEST_F(LockRoutes, KeepSwapsOffTheEdges) {
    const std::string line = R"({"type": "LineString", "coordinates": [[1,4],[6,9]]})";
    const auto paper = [&] {
        const Response made = post(session + "/polygons?improve=paper", line);
        EXPECT_EQ(made.status, 200) << made.body;
        return locked();
    };
    lock(kDiagonal);
    EXPECT_EQ(paper(), json::parse("[[2,0]]"));
}

TEST_F(LockRoutes, TakeSeveralLinesWholeOrNotAtAll) {
    post(session + "/polygons", kBorder);
    const Response made = lock(kBorder);
    ASSERT_EQ(made.status, 200) << made.body;
    // The diagonal runs through two of its corners.
    EXPECT_EQ(json::parse(made.body)["length"], 12.0);
    EXPECT_EQ(json::parse(made.body)["without_edge"], json::array());
    const std::string two = R"({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": null, "geometry": )" +
                            std::string(kDiagonal) + R"(},
        {"type": "Feature", "properties": null, "geometry":
         {"type": "MultiLineString", "coordinates": [[[0,1],[1,9]],[[2,2],[5,2]],[[0,3],[1,8]]]}}]})";
    const std::string list = locked().dump();
    const Response refused = lock(two);
    EXPECT_EQ(refused.status, 422);
    EXPECT_EQ(told(refused), "NO_EDGE_ALONG NO_EDGE_ALONG");
    EXPECT_EQ(json::parse(refused.body)["errors"][0]["pointer"],
              "/features/1/geometry/coordinates/0");
    EXPECT_EQ(json::parse(refused.body)["errors"][1]["pointer"],
              "/features/1/geometry/coordinates/2");
    EXPECT_EQ(locked().dump(), list);
    EXPECT_EQ(version_of(session), 3);
}

TEST_F(LockRoutes, NameWhatLiesAlongNoEdge) {
    post(session + "/polygons", kBorder);
    const Response made =
        lock(R"({"type": "LineString", "coordinates": [[2,2],[5,2],[7,2],[7,3]]})");
    EXPECT_EQ(json::parse(made.body)["without_edge"],
              json::parse(R"([{"path": 0, "points": [[5,2],[7,2],[7,3]]}])"));
}

TEST_F(LockRoutes, AreOperations) {
    post(session + "/polygons", kBorder);
    post(session + "/polygons", kDiagonal);
    const std::string none = locked().dump();
    lock(kBorder);
    const std::string all = locked().dump();
    EXPECT_NE(all, none);
    EXPECT_EQ(json::parse(ask("POST", session + "/undo").body)["of"], 4);
    EXPECT_EQ(locked().dump(), none);
    ask("POST", session + "/redo");
    EXPECT_EQ(locked().dump(), all);
    const Response forked = ask("POST", session + "/fork");
    const std::string fork = "/v1/sessions/" + json::parse(forked.body)["id"].get<std::string>();
    EXPECT_EQ(json::parse(ask("GET", fork + "/locks").body)["tinsmith"]["vertices"].dump(), all);
    // The border is gone with its polygon, and there is nothing left to lock.
    ASSERT_EQ(ask("DELETE", session + "/polygons/p1").status, 200);
    EXPECT_EQ(locked(), json::array());
    ask("POST", session + "/undo");
    EXPECT_EQ(locked().dump(), all);
    const json history = json::parse(ask("GET", session + "/history").body)["changes"];
    EXPECT_EQ(history[3]["change"], "locks");
    EXPECT_EQ(history[3]["polygons"], json::array());
}

TEST_F(LockRoutes, ChangeMarksAlone) {
    const Response delta = lock(kDiagonal, {}, {{"accept", "application/vnd.tinsmith.delta"}});
    ASSERT_EQ(delta.status, 200);
    EXPECT_EQ(delta.body.size(), 48U) << "the head alone";
    EXPECT_EQ(delta.body.substr(0, 4), "TNDL");
}

TEST_F(LockRoutes, TryFirst) {
    const Response tried = lock(kDiagonal, "?dry_run=true");
    EXPECT_EQ(json::parse(tried.body)["changed"], 1);
    EXPECT_EQ(json::parse(tried.body)["version"], 1);
    EXPECT_EQ(locked(), json::array());
    EXPECT_EQ(version_of(session), 1);
    const std::string beside = R"({"type": "LineString", "coordinates": [[0.1,0],[10.1,10]]})";
    EXPECT_EQ(told(lock(beside)), "NO_EDGE_ALONG");
    EXPECT_EQ(lock(beside, "?snap=0.2").status, 200);
}

TEST_F(LockRoutes, HonourConditionsAndKeys) {
    const std::string old = header(ask("GET", session), "ETag");
    EXPECT_EQ(lock(kDiagonal, {}, {{"if-match", old}, {"idempotency-key", "k"}}).status, 200);
    EXPECT_EQ(lock(kDiagonal, {}, {{"if-match", old}}).status, 412);
    const Response again = lock(kDiagonal, {}, {{"if-match", old}, {"idempotency-key", "k"}});
    EXPECT_EQ(header(again, "Idempotency-Replayed"), "true");
    EXPECT_EQ(version_of(session), 2);
}

TEST_F(LockRoutes, NameAllFaults) {
    EXPECT_EQ(told(lock(R"({"type": "Point", "coordinates": [1,1]})")), "GEOJSON_TYPE");
    EXPECT_EQ(told(lock("{")), "JSON_SYNTAX");
    EXPECT_EQ(told(lock(kDiagonal, "?improve=none")), "UNKNOWN_PARAMETER");
    EXPECT_EQ(told(lock(kDiagonal, "?snap=-1&dry_run=2")), "INVALID_OPTION INVALID_OPTION");
    EXPECT_EQ(told(lock(kDiagonal, "?crs=EPSG:999999")), "CRS_UNKNOWN");
    EXPECT_EQ(told(lock(R"({"type": "LineString", "coordinates": [[0,0],[10,10]],
                           "tinsmith": {"improve": "none", "lock": true}})")),
              "UNKNOWN_OPTION UNKNOWN_OPTION");
    EXPECT_EQ(ask("PUT", session + "/locks", {{"content-type", "text/csv"}}, "1,2").status, 415);
    EXPECT_EQ(ask("PUT", "/v1/sessions/none/locks", {}, kDiagonal).status, 404);
    EXPECT_EQ(version_of(session), 1);
}

TEST_F(LockRoutes, ComeInPages) {
    post(session + "/polygons?lock=true", kBorder);
    const json all = locked();
    ASSERT_GT(all.size(), 3U);
    json pages = json::array();
    std::string next = session + "/locks?limit=2";
    while (!next.empty()) {
        const Response page = ask("GET", next);
        ASSERT_EQ(page.status, 200) << page.body;
        const json part = json::parse(page.body)["tinsmith"]["vertices"];
        EXPECT_LE(part.size(), 2U);
        for (const json& edge : part)
            pages.push_back(edge);
        const std::string link = header(page, "Link");
        next = link.empty() ? "" : link.substr(1, link.find('>') - 1);
    }
    EXPECT_EQ(pages, all);
}

class FewVisits : public Handlers {
  protected:
    static Limits few_visits() {
        Limits limits = few_sessions();
        limits.max_crossings = 20;
        return limits;
    }
    Services tight{few_visits()};
};

TEST_F(FewVisits, EndALockWithMuchInReach) {
    router = Router(make_routes(tight));
    const std::string session = make_session();
    const std::vector<NameValue> json_body{{"content-type", "application/json"}};
    EXPECT_EQ(ask("PUT", session + "/locks", json_body, kDiagonal).status, 200);
    const std::string wide = R"({"type": "LineString",
        "coordinates": [[0,0],[10,10],[0,0],[10,10],[0,0],[10,10],[0,0],[10,10]]})";
    const Response refused = ask("PUT", session + "/locks?snap=1000", json_body, wide);
    EXPECT_EQ(refused.status, 422) << refused.body;
    EXPECT_EQ(told(refused), "CROSSING_BUDGET");
    EXPECT_EQ(version_of(session), 2);
}

}  // namespace
}  // namespace tinsmith::server
