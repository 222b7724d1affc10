// SPDX-License-Identifier: Apache-2.0
// Lists by pages, answers in types that are asked for, and coded answers, as a client meets them.
#include "server/routes/paging.hpp"

#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

class Paging : public Handlers {
  protected:
    /// Where Link leads on; empty: nowhere.
    static std::string next(const Response& response) {
        const std::string link = header(response, "Link");
        if (link.empty()) return "";
        EXPECT_TRUE(link.starts_with('<') && link.ends_with(">; rel=\"next\"")) << link;
        return link.substr(1, link.find('>') - 1);
    }

    std::string polygon_ids(const std::string& target, std::size_t most) {
        std::string ids;
        for (std::string page = target; !page.empty();) {
            const Response response = ask("GET", page);
            EXPECT_EQ(response.status, 200) << response.body;
            const auto features = json::parse(response.body)["features"];
            EXPECT_LE(features.size(), most);
            for (const auto& feature : features)
                ids += feature["tinsmith"]["id"].get<std::string>() + " ";
            page = next(response);
        }
        return ids;
    }
};

TEST_F(Paging, GoesThroughSessions) {
    for (const char* id : {"b", "a", "c"}) {
        ASSERT_EQ(ask("PUT", std::string("/v1/sessions/") + id,
                      {{"content-type", "application/json"}}, kSquare)
                      .status,
                  201);
    }
    EXPECT_EQ(next(ask("GET", "/v1/sessions")), "");
    EXPECT_EQ(next(ask("GET", "/v1/sessions?limit=3")), "");
    const Response first = ask("GET", "/v1/sessions?limit=2");
    EXPECT_EQ(json::parse(first.body)["sessions"].size(), 2U);
    ASSERT_EQ(ask("DELETE", "/v1/sessions/b").status, 200);
    const Response second = ask("GET", next(first));
    ASSERT_EQ(second.status, 200) << second.body;
    EXPECT_EQ(json::parse(second.body)["sessions"][0]["id"], "c") << "the place stays good";
    EXPECT_EQ(next(second), "");
}

TEST_F(Paging, GoesThroughHistory) {
    const std::string session = make_session();
    for (int i = 1; i <= 6; ++i)
        post(session + "/polygons",
             R"({"type":"Point","coordinates":[)" + std::to_string(i) + ",5]}");
    const json whole = json::parse(ask("GET", session + "/history").body);
    json changes = json::array();
    for (std::string page = session + "/history?limit=3"; !page.empty();) {
        const Response response = ask("GET", page);
        const json part = json::parse(response.body);
        EXPECT_EQ(part["oldest"], 1);
        EXPECT_EQ(part["undo"], 7);
        EXPECT_LE(part["changes"].size(), 3U);
        for (const json& change : part["changes"])
            changes.push_back(change);
        page = next(response);
    }
    EXPECT_EQ(changes.size(), 7U);
    EXPECT_EQ(changes, whole["changes"]);
    EXPECT_EQ(ask("GET", session + "/history?limit=0").status, 400);
}

TEST_F(Paging, GoesThroughPolygons) {
    const std::string path = make_session() + "/polygons";
    std::string all;
    for (int i = 1; i <= 12; ++i) {
        const std::string x = std::to_string(i * 0.7);
        ASSERT_EQ(post(path, R"({"type":"Point","coordinates":[)" + x + ",5.1]}").status, 200);
        all += "p" + std::to_string(i) + " ";
    }
    EXPECT_EQ(polygon_ids(path, 12), all);
    EXPECT_EQ(polygon_ids(path + "?limit=1", 1), all);
    EXPECT_EQ(polygon_ids(path + "?limit=5", 5), all);
    EXPECT_EQ(polygon_ids(path + "?limit=12", 12), all);
    EXPECT_NE(next(ask("GET", path + "?limit=5")).find("limit=5&cursor="), std::string::npos);
}

TEST_F(Paging, RefusesWhatIsNoPage) {
    const std::string path = make_session() + "/polygons";
    for (const char* query :
         {"limit=0", "limit=1001", "limit=-1", "limit=", "limit=2x", "limit=99999999999999999999",
          "cursor=", "cursor=x", "cursor=7", "cursor=70", "cursor=zz", "cursor=706f6c79676f6e3a",
          "cursor=706f6c79676f6e3a0a"}) {
        const Response refused = ask("GET", path + "?" + query);
        EXPECT_EQ(refused.status, 400) << query;
        EXPECT_EQ(told(refused), "INVALID_PARAMETER") << query;
    }
    EXPECT_EQ(told(ask("GET", path + "?limit=0&cursor=x")), "INVALID_PARAMETER INVALID_PARAMETER");
    make_session();
    const std::string other = next(ask("GET", "/v1/sessions?limit=1"));
    EXPECT_EQ(ask("GET", path + other.substr(other.find('?'))).status, 400)
        << "a cursor of another list";
}

TEST_F(Paging, AnswersOnlyInTypesThatAreAccepted) {
    const std::string session = make_session();
    for (const std::string& path :
         {std::string("/v1/sessions"), std::string("/v1/limits"), session, session + "/polygons"}) {
        EXPECT_EQ(ask("GET", path, {{"accept", "text/html,*/*;q=0.1"}}).status, 200) << path;
        const Response refused = ask("GET", path, {{"accept", "text/html"}});
        EXPECT_EQ(refused.status, 406) << path;
        EXPECT_NE(refused.body.find("application/json"), std::string::npos);
    }
    EXPECT_EQ(post("/v1/sessions", kSquare, {{"accept", "text/html"}}).status, 406);
    EXPECT_EQ(services.sessions.size(), 1U);
}

TEST_F(Paging, SendsACodedMeshOfTheSameTag) {
    const std::string grid = R"({"grid": {"origin": [0,0], "cell": [1,1], "columns": 20, "rows": 20,
                                 "elevations": [)";
    std::string elevations;
    for (int i = 0; i < 400; ++i)
        elevations += (i > 0 ? "," : "") + std::to_string(i % 7);
    const Response made = post("/v1/sessions", grid + elevations + "]}}");
    ASSERT_EQ(made.status, 201) << made.body;
    const std::string mesh = header(made, "Location") + "/mesh.json";
    const NameValue takes{"accept-encoding", "gzip"};
    const Response plain = ask("GET", mesh);
    const Response coded = ask("GET", mesh, {takes});
    EXPECT_EQ(header(coded, "Content-Encoding"), "gzip");
    EXPECT_LT(coded.body.size(), plain.body.size());
    const std::string tag = header(coded, "ETag");
    EXPECT_EQ(tag, header(plain, "ETag").insert(header(plain, "ETag").size() - 1, "-gzip"));
    EXPECT_EQ(ask("HEAD", mesh, {takes}).body.size(), coded.body.size());
    EXPECT_EQ(services.meshes.counts().encodings, 2U) << "once plain, once coded";
    const Response same = ask("GET", mesh, {takes, {"if-none-match", tag}});
    EXPECT_EQ(same.status, 304);
    EXPECT_EQ(header(same, "ETag"), tag);
    EXPECT_EQ(ask("GET", mesh, {{"if-none-match", tag}}).status, 200) << "takes no gzip now";
    EXPECT_EQ(ask("DELETE", header(made, "Location"), {{"if-match", tag}}).status, 200);
}

}  // namespace
}  // namespace tinsmith::server
