// SPDX-License-Identifier: Apache-2.0
// The routes as a client meets them, without a socket.
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

TEST_F(Handlers, TellHealthAndLimits) {
    EXPECT_EQ(ask("GET", "/healthz").status, 200);
    EXPECT_EQ(json::parse(ask("GET", "/v1/limits").body)["max_sessions"], 3);
    EXPECT_EQ(json::parse(ask("GET", "/v1/limits").body)["mesh_cache"], 256 << 20);
    EXPECT_EQ(json::parse(ask("GET", "/v1/limits").body)["max_points"], 100'000);
    EXPECT_EQ(json::parse(ask("GET", "/v1/limits").body)["max_profile_crossings"], 1'000'000);
    EXPECT_EQ(ask("GET", "/").status, 200);
}

TEST_F(Handlers, MakeListAndDeleteSessions) {
    const Response made = post("/v1/sessions", kSquare);
    ASSERT_EQ(made.status, 201) << made.body;
    const auto session = json::parse(made.body);
    EXPECT_EQ(session["name"], "Square");
    EXPECT_EQ(session["crs"], "EPSG:32616");
    EXPECT_EQ(session["version"], 1);
    EXPECT_EQ(session["triangles"], 2);
    EXPECT_EQ(session["bounds"], json::parse("[0.0,0.0,0.0,10.0,10.0,3.0]"));
    const std::string path = header(made, "Location");
    EXPECT_EQ(path, "/v1/sessions/" + session["id"].get<std::string>());
    const Response found = ask("GET", path);
    EXPECT_EQ(found.body, made.body);
    EXPECT_EQ(header(found, "ETag"), header(made, "ETag"));
    EXPECT_EQ(json::parse(ask("GET", "/v1/sessions").body)["sessions"].size(), 1U);
    EXPECT_EQ(ask("DELETE", path).status, 200);
    EXPECT_EQ(told(ask("GET", path)), "no-such-session");
    EXPECT_EQ(ask("DELETE", path).status, 404);
}

TEST_F(Handlers, MakeASessionUnderAnIdOfChoice) {
    const NameValue type{"content-type", "application/json"};
    const Response made = ask("PUT", "/v1/sessions/hills", {type}, kSquare);
    EXPECT_EQ(made.status, 201) << made.body;
    EXPECT_EQ(header(made, "Location"), "/v1/sessions/hills");
    EXPECT_EQ(ask("GET", "/v1/sessions/hills").body, made.body);
    const Response again = ask("PUT", "/v1/sessions/hills", {type}, kSquare);
    EXPECT_EQ(again.status, 409);
    EXPECT_EQ(told(again), "id-taken");
    EXPECT_EQ(ask("PUT", "/v1/sessions/a%20b", {type}, kSquare).status, 400);
    EXPECT_EQ(ask("PUT", "/v1/sessions/..", {type}, kSquare).status, 400);
    EXPECT_EQ(ask("PUT", "/v1/sessions/x", {type}, "{").status, 400);
    EXPECT_EQ(ask("GET", "/v1/sessions/x").status, 404);
}

TEST_F(Handlers, ForkASessionThatThenGoesItsOwnWay) {
    const std::string first = make_session();
    ASSERT_EQ(post(first + "/polygons", kParcel).status, 200);
    const Response forked = ask("POST", first + "/fork");
    ASSERT_EQ(forked.status, 201) << forked.body;
    const auto made = json::parse(forked.body);
    const std::string second = "/v1/sessions/" + made["id"].get<std::string>();
    EXPECT_EQ(header(forked, "Location"), second);
    EXPECT_EQ(made["version"], 2);
    EXPECT_EQ(made["polygons"], 1);
    EXPECT_EQ(ask("GET", second + "/mesh.json").body, ask("GET", first + "/mesh.json").body);

    const std::string before = ask("GET", first + "/mesh.json").body;
    const Response edited = post(second + "/polygons", R"({"type":"Point","coordinates":[8,8.5]})");
    ASSERT_EQ(edited.status, 200) << edited.body;
    EXPECT_EQ(json::parse(edited.body)["polygons"][0]["id"], "p2") << "ids go on where they were";
    EXPECT_EQ(ask("GET", first + "/mesh.json").body, before);
    EXPECT_NE(ask("GET", second + "/mesh.json").body, before);
    EXPECT_EQ(ask("POST", first + "/fork", {}, "{}").status, 400);
    EXPECT_EQ(ask("POST", "/v1/sessions/none/fork").status, 404);
}

TEST_F(Handlers, RefuseTooManySessionsByName) {
    for (int i = 0; i < 3; ++i)
        make_session();
    const Response refused = post("/v1/sessions", kSquare);
    EXPECT_EQ(refused.status, 429);
    EXPECT_NE(refused.body.find("max_sessions"), std::string::npos);
}

TEST_F(Handlers, SayWhatCurlForgot) {
    const Response refused = ask("POST", "/v1/sessions",
                                 {{"content-type", "application/x-www-form-urlencoded"}}, kSquare);
    EXPECT_EQ(refused.status, 415);
    EXPECT_NE(refused.body.find("-H 'Content-Type: application/json'"), std::string::npos);
    EXPECT_NE(refused.body.find("image/tiff"), std::string::npos);
    EXPECT_EQ(ask("POST", "/v1/sessions", {}, kSquare).status, 415);
    EXPECT_EQ(ask("POST", make_session() + "/polygons", {{"content-type", "text/csv"}}, "").status,
              415);
}

TEST_F(Handlers, PointAtFaultsOfAMesh) {
    const Response refused = post("/v1/sessions", R"({"mesh": {
        "vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2],[0,1,9],[0,1,1]]}})");
    EXPECT_EQ(refused.status, 422);
    EXPECT_NE(refused.body.find("/mesh/triangles/1"), std::string::npos) << refused.body;
}

TEST_F(Handlers, IntegrateAPolygon) {
    const std::string session = make_session();
    const Response done = post(session + "/polygons", kParcel);
    ASSERT_EQ(done.status, 200) << done.body;
    const auto report = json::parse(done.body);
    EXPECT_EQ(report["version"], 2);
    EXPECT_EQ(report["dry_run"], false);
    EXPECT_EQ(report["polygons"][0]["id"], "p1");
    EXPECT_EQ(report["totals"]["segments"], 4);
    const auto after = json::parse(ask("GET", session).body);
    EXPECT_EQ(after["version"], 2);
    EXPECT_EQ(after["polygons"], 1);
    EXPECT_EQ(after["triangles"].get<int>(), 2 + report["totals"]["triangles_added"].get<int>());
    EXPECT_EQ(header(done, "ETag"), header(ask("GET", session), "ETag"));
}

TEST_F(Handlers, TryWithoutTouching) {
    const std::string session = make_session();
    const std::string before = ask("GET", session + "/mesh.json").body;
    const auto report = json::parse(post(session + "/polygons?dry_run=true", kParcel).body);
    EXPECT_EQ(report["dry_run"], true);
    EXPECT_EQ(report["version"], 1);
    EXPECT_EQ(report["polygons"][0]["vertices_added"], 4);
    EXPECT_EQ(ask("GET", session + "/mesh.json").body, before);
}

TEST_F(Handlers, AnswerWithTheMeshIfAsked) {
    const std::string session = make_session();
    const Response glb = post(session + "/polygons", kParcel, {{"accept", "model/gltf-binary"}});
    EXPECT_EQ(glb.status, 200);
    EXPECT_EQ(glb.content_type, "model/gltf-binary");
    EXPECT_EQ(glb.body.substr(0, 4), "glTF");
    EXPECT_EQ(version_of(session), 2);
    EXPECT_EQ(post(session + "/polygons", kParcel, {{"accept", "text/html"}}).status, 406);
    EXPECT_EQ(version_of(session), 2);
}

TEST_F(Handlers, LeaveTheSessionAloneWhateverTheFault) {
    const std::string session = make_session();
    const std::string before = ask("GET", session + "/mesh.json").body;
    struct Case {
        const char* body;
        int status;
    };
    for (const auto& [body, status] : std::vector<Case>{
             {R"({"type": "Polygon", "coordinates": [[[NaN,2],[5,2],[5,5],[2,2]]]})", 400},
             {R"({"type": "Polygon", "coordinates": [[[1e999,2],[5,2],[5,5],[2,2]]]})", 422},
             {R"({"type": "Polygon", "coordinates": [[["2",2],[5,2],[5,5],[2,2]]]})", 422},
             {R"({"type": "Polygon", "coordinates": [[[2,2],[5,2],[2,2]]]})", 422},
             {R"({"type": "Pentagon", "coordinates": []})", 422},
             {R"({"type": "Polygon", "coordinates": [[[20,20],[50,20],[50,50],[20,20]]]})", 422},
             {R"({"type": "Polygon"})", 422},
             {"null", 422},
             {"[", 400},
             {"", 400}}) {
        const Response refused = post(session + "/polygons", body);
        EXPECT_EQ(refused.status, status) << body << "\n" << refused.body;
        EXPECT_EQ(refused.content_type, "application/problem+json");
        EXPECT_TRUE(json::parse(refused.body).contains("errors")) << refused.body;
    }
    EXPECT_EQ(ask("GET", session + "/mesh.json").body, before);
    EXPECT_EQ(version_of(session), 1);
}

TEST_F(Handlers, HonourIfMatch) {
    const std::string session = make_session();
    const std::string tag = header(ask("GET", session), "ETag");
    EXPECT_EQ(post(session + "/polygons", kParcel, {{"if-match", tag}}).status, 200);
    const Response stale = post(session + "/polygons", kParcel, {{"if-match", tag}});
    EXPECT_EQ(stale.status, 412);
    EXPECT_EQ(header(stale, "ETag"), header(ask("GET", session), "ETag"));
    EXPECT_EQ(post(session + "/polygons", kParcel, {{"if-match", "\"nonsense\""}}).status, 412);
    EXPECT_EQ(ask("DELETE", session, {{"if-match", tag}}).status, 412);
    const std::string now = header(ask("GET", session), "ETag");
    const std::string dry = session + "/polygons?dry_run=true";
    EXPECT_EQ(post(dry, kParcel, {{"if-match", "\"x\" , " + now}}).status, 200);
    EXPECT_EQ(post(dry, kParcel, {{"if-match", now + "," + tag}}).status, 200);
    EXPECT_EQ(post(dry, kParcel, {{"if-match", tag}, {"if-match", now}}).status, 200);
    EXPECT_EQ(post(dry, kParcel, {{"if-match", tag + ", \"x\""}}).status, 412);
    EXPECT_EQ(post(dry, kParcel, {{"if-match", "W/" + now}}).status, 412) << "strong tags only";
    EXPECT_EQ(post(dry, kParcel, {{"if-match", ",, "}}).status, 412);
    const std::string mesh_tag = header(ask("GET", session + "/mesh"), "ETag");
    EXPECT_EQ(ask("DELETE", session, {{"if-match", mesh_tag}}).status, 200);
}

TEST_F(Handlers, SendTheMeshInTheFormAskedFor) {
    const std::string mesh = make_session() + "/mesh";
    EXPECT_EQ(ask("GET", mesh).content_type, "model/gltf-binary");
    EXPECT_EQ(ask("GET", mesh, {{"accept", "application/json"}}).content_type, "application/json");
    EXPECT_EQ(ask("GET", mesh + ".glb", {{"accept", "text/html"}}).status, 200);
    EXPECT_EQ(ask("GET", mesh, {{"accept", "text/html"}}).status, 406);
    const Response glb = ask("GET", mesh + "?compression=none&up=z&tolerance=0.001");
    EXPECT_EQ(glb.status, 200);
    EXPECT_NE(header(glb, "Tinsmith-Max-Error"), "");
    EXPECT_EQ(header(glb, "Tinsmith-Flipped-Triangles"), "0");
    EXPECT_EQ(ask("GET", mesh + "?tolerance=-1").status, 400);
    const Response too_fine = ask("GET", mesh + "?tolerance=1e-12");
    EXPECT_EQ(too_fine.status, 400);
    EXPECT_EQ(header(too_fine, "ETag"), "") << "a refusal is no representation";
    EXPECT_EQ(ask("GET", mesh + "?compression=meshopt").status, 200);
    EXPECT_EQ(ask("GET", mesh + ".json?up=z").status, 400);
    EXPECT_EQ(json::parse(ask("GET", mesh + ".json").body)["triangles"].size(), 2U);
}

}  // namespace
}  // namespace tinsmith::server
