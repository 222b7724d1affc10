// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

#include "api/formats/delta.hpp"
#include "server/demo.hpp"
#include "server/reply.hpp"
#include "tests/support/delta_client.hpp"
#include "tests/support/random_input.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

using test::DeltaClient;

const NameValue kAsDelta{"accept", "application/vnd.tinsmith.delta"};
const NameValue kAsJson{"accept", "application/json"};

class DeltaRoutes : public Handlers {
  protected:
    std::string session = make_session();

    /// Empty: the client's buffers are the session's mesh, bit for bit.
    std::string compare(const DeltaClient& client) {
        const MeshCopy copy = services.sessions.find(session.substr(13), {})->copy_mesh();
        if (client.version() != copy.version) return "another version";
        if (client.vertices().size() != copy.mesh.vertices.size() ||
            client.triangles() != copy.mesh.triangles)
            return "other triangles";
        const bool same = std::memcmp(client.vertices().data(), copy.mesh.vertices.data(),
                                      client.vertices().size() * sizeof client.vertices()[0]) == 0;
        return same ? "" : "other vertices";
    }

    Response since(std::uint64_t version, const NameValue& accept) {
        return ask("GET", session + "/mesh?since=" + std::to_string(version), {accept});
    }

    /// A polygons body; in one of three cases with elevations, which move vertices.
    static std::string random_polygons(test::Random& random) {
        json features = json::array();
        for (int i = 1 + test::pick(random, 3); i > 0; --i) {
            const double x = test::uniform(random, -1, 8);
            const double y = test::uniform(random, -1, 8);
            const double w = test::uniform(random, 0.1, 5);
            const double h = test::uniform(random, 0.1, 5);
            const double z = test::uniform(random, -3, 3);
            features.push_back(
                {{"type", "Feature"},
                 {"properties", nullptr},
                 {"geometry",
                  {{"type", "Polygon"},
                   {"coordinates", {{{x, y, z}, {x + w, y, z}, {x + w, y + h, z}, {x, y, z}}}}}}});
        }
        json body{{"type", "FeatureCollection"}, {"features", features}};
        if (test::pick(random, 3) == 0) body["tinsmith"] = {{"elevation", "own"}};
        return body.dump();
    }

    /// An edit of one of the polygons; of each kind, removals and trims not too often, which leave
    /// little to go on with.
    static std::string random_edit(test::Random& random, const json& features) {
        json body{{"polygon", features[random() % features.size()]["tinsmith"]["id"]}};
        const double width = test::uniform(random, 0.01, 0.5);
        switch (test::pick(random, 10)) {
            case 0:
                body["operation"] = "remove";
                break;
            case 1:
                body["operation"] = "keep";
                break;
            case 2:
            case 3:
                body.update({{"operation", "smooth"}, {"passes", 1 + test::pick(random, 5)}});
                break;
            case 4:
            case 5:
                body.update({{"operation", "offset"},
                             {"by", test::uniform(random, -1, 1)},
                             {"rim", width}});
                break;
            case 6:
                body.update({{"operation", "offset"}, {"by", 1}, {"taper", width}});
                break;
            default:
                body.update({{"operation", "set"}, {"elevation", test::uniform(random, -3, 3)}});
                if (test::pick(random, 2) == 0) body["border"] = "new";
        }
        return body.dump();
    }

    /// Some change or other, answered as a delta; perhaps refused.
    Response change(test::Random& random) {
        const json list = json::parse(ask("GET", session + "/polygons", {kAsJson}).body);
        const json& features = list["features"];
        switch (test::pick(random, 16)) {
            case 0:
            case 1:
            case 2:
                return ask("POST", session + "/undo", {kAsDelta});
            case 3:
            case 4:
            case 5:
                return ask("POST", session + "/redo", {kAsDelta});
            case 6:
            case 7: {
                if (features.empty()) return {};
                const auto& some = features[random() % features.size()];
                return ask("DELETE",
                           session + "/polygons/" + some["tinsmith"]["id"].get<std::string>() +
                               "?cascade=true",
                           {kAsDelta});
            }
            case 8:
            case 9:
            case 10:
            case 11:
            case 12:
                if (features.empty()) return {};
                return post(session + "/edits", random_edit(random, features), {kAsDelta});
            default:
                return post(session + "/polygons", random_polygons(random), {kAsDelta});
        }
    }
};

TEST_F(DeltaRoutes, PatchAClientThroughTwoThousandChanges) {
    test::Random random(7);
    DeltaClient direct, by_bytes, by_json, late;
    for (DeltaClient* client : {&direct, &by_bytes, &by_json, &late})
        ASSERT_EQ(client->patch(since(0, kAsDelta).body), "");
    int changes = 0;
    std::map<std::string, int> made;
    for (int i = 0; changes < 2000; ++i) {
        ASSERT_LT(i, 8000);
        // Now and then anew, so that the mesh stays small.
        if (i % 60 == 59) {
            ask("DELETE", session);
            session = make_session();
            for (DeltaClient* client : {&direct, &by_bytes, &by_json, &late}) {
                *client = {};
                ASSERT_EQ(client->patch(since(0, kAsDelta).body), "");
            }
        }
        const Response answer = change(random);
        if (answer.status != 200 || answer.body.empty()) continue;
        ++changes;
        ASSERT_EQ(answer.content_type, kDelta);
        ASSERT_EQ(direct.patch(answer.body), "");
        ASSERT_EQ(by_bytes.patch(since(by_bytes.version(), kAsDelta).body), "");
        ASSERT_EQ(by_json.patch_json(since(by_json.version(), kAsJson).body), "");
        for (const DeltaClient* client : {&direct, &by_bytes, &by_json})
            ASSERT_EQ(compare(*client), "") << "change " << changes;
        if (test::pick(random, 4) == 0) {  // over several changes at once
            ASSERT_EQ(late.patch(since(late.version(), kAsDelta).body), "");
            ASSERT_EQ(compare(late), "") << "change " << changes;
        }
        const json entry = json::parse(ask("GET", session + "/history").body)["changes"].back();
        const std::string version = std::to_string(entry["version"].get<int>());
        const json report = json::parse(ask("GET", session + "/history/" + version).body);
        ++made[report.value("operation", entry["change"].get<std::string>())];
        ASSERT_TRUE(api::read_delta(answer.body).ok()) << "by the service's own reader";
    }
    EXPECT_EQ(made.size(), 9U);
    for (const auto& [what, count] : made) {
        std::printf("%s %d\n", what.c_str(), count);
        EXPECT_GT(count, 30) << what;
    }
}

TEST_F(DeltaRoutes, SayWhenTheyAreTheWhole) {
    const json whole = json::parse(since(0, kAsJson).body);
    EXPECT_EQ(whole["whole"], true);
    EXPECT_EQ(whole["vertices"][0]["positions"].size(), 4U);
    // Moves all four corners and cuts both triangles: nothing is left to be spared.
    post(session + "/polygons?elevation=own", R"({"type": "MultiLineString", "coordinates": [
        [[0,0,9],[10,0,8],[10,10,7],[0,10,6],[0,0,9]], [[1,4,2],[9,5,2]]]})");
    EXPECT_EQ(version_of(session), 2);
    EXPECT_EQ(json::parse(since(1, kAsJson).body)["whole"], true);
    const json nothing = json::parse(since(2, kAsJson).body);
    EXPECT_EQ(nothing["whole"], false);
    EXPECT_TRUE(nothing["vertices"].empty());
    ask("POST", session + "/undo");
    const json back = json::parse(since(2, kAsJson).body);
    EXPECT_EQ(back["vertex_count"]["new"], 4);
    EXPECT_EQ(back["vertices"][0]["positions"].size(), 4U);
}

TEST_F(DeltaRoutes, RefuseVersionsAndParametersByName) {
    EXPECT_EQ(told(since(2, kAsDelta)), "no-such-version");
    EXPECT_EQ(told(ask("GET", session + "/mesh?since=x")), "INVALID_VALUE");
    EXPECT_EQ(told(ask("GET", session + "/mesh?since=1&up=z")), "INVALID_VALUE");
    EXPECT_EQ(told(ask("GET", session + "/mesh.json?since=1")), "UNKNOWN_PARAMETER");
    EXPECT_EQ(since(1, {"accept", "model/gltf-binary"}).status, 406);
    const Response dry = post(session + "/polygons?dry_run=true", kParcel, {kAsDelta});
    EXPECT_EQ(told(dry), "invalid-parameter");
    EXPECT_EQ(version_of(session), 1);
}

TEST_F(DeltaRoutes, NameTheOldestVersionThatIsKept) {
    Limits limits;
    limits.max_history = 3;
    Services few(limits);
    const Router its_router(make_routes(few));
    const auto tell = [&its_router](const std::string& method, const std::string& path,
                                    std::vector<NameValue> query, const std::string& body) {
        Request request;
        request.method = method;
        request.path = "/v1/sessions/a" + path;
        request.query = std::move(query);
        request.headers = {{"content-type", "application/json"}};
        request.body = body;
        return its_router.handle(request);
    };
    ASSERT_EQ(tell("PUT", "", {}, kSquare).status, 201);
    for (int i = 0; i < 5; ++i)
        EXPECT_EQ(tell("POST", "/polygons", {}, kParcel).status, 200);
    const Response gone = tell("GET", "/mesh", {{"since", "2"}}, {});
    EXPECT_EQ(gone.status, 410);
    EXPECT_NE(gone.body.find("oldest kept is 3"), std::string::npos) << gone.body;
    EXPECT_EQ(tell("GET", "/mesh", {{"since", "3"}}, {}).status, 200);
    EXPECT_EQ(tell("GET", "/history/2", {}, {}).status, 410);
    EXPECT_EQ(told(tell("DELETE", "/polygons/p1", {}, {})), "polygon-settled");
}

std::string file_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(DeltaOfTheLake, IsSmallBesideTheMesh) {
    const std::string data = std::string(TINSMITH_SOURCE_DIR) + "/tests/data/";
    Services services{Limits{}};
    ASSERT_EQ(load_demo(services, data + "jacksboro.tif"), "");
    const Router router(make_routes(services));
    const auto ask = [&router](const std::string& method, const std::string& path,
                               std::vector<NameValue> query, const std::string& accept,
                               const std::string& body = {}) {
        Request request;
        request.method = method;
        request.path = "/v1/sessions/demo" + path;
        request.query = std::move(query);
        request.headers = {{"accept", accept}, {"content-type", "application/json"}};
        request.body = body;
        return router.handle(request);
    };
    DeltaClient client;
    ASSERT_EQ(client.patch(ask("GET", "/mesh", {{"since", "0"}}, kDelta).body), "");
    const Response delta = ask("POST", "/polygons", {}, kDelta, file_text(data + "lake.geojson"));
    ASSERT_EQ(delta.status, 200) << delta.body;
    ASSERT_EQ(client.patch(delta.body), "");
    const Response as_json = ask("GET", "/mesh", {{"since", "1"}}, kJson);
    const Response draco = ask("GET", "/mesh.glb", {}, kGlb);
    const Response plain = ask("GET", "/mesh.glb", {{"compression", "none"}}, kGlb);
    const auto percent = [&delta](const Response& of) {
        return 100.0 * static_cast<double>(delta.body.size()) /
               static_cast<double>(of.sent().size());
    };
    std::printf(
        "lake: delta %zu bytes, as JSON %zu; full GLB %zu (%.2f %%), plain GLB %zu (%.2f %%)\n",
        delta.body.size(), as_json.body.size(), draco.body.size(), percent(draco),
        plain.body.size(), percent(plain));
    EXPECT_LT(percent(plain), 5.0);
}

}  // namespace
}  // namespace tinsmith::server
