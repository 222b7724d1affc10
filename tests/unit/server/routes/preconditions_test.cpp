// SPDX-License-Identifier: Apache-2.0
// ETag, If-Match and If-None-Match as a client meets them, and the cache of encoded meshes.
#include <atomic>
#include <set>
#include <thread>

#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

class Conditions : public Handlers {
  protected:
    std::string tag_of(const std::string& target, std::vector<NameValue> headers = {}) {
        return header(ask("GET", target, std::move(headers)), "ETag");
    }
};

TEST_F(Conditions, TellWhatIsNotModified) {
    const std::string session = make_session();
    ASSERT_EQ(post(session + "/polygons", kParcel).status, 200);
    for (const std::string& path :
         {session, session + "/mesh", session + "/mesh.json", session + "/mesh.glb?up=z",
          session + "/polygons", session + "/polygons/p1"}) {
        const std::string tag = tag_of(path);
        for (const std::string& field : {tag, "W/" + tag, "\"x\", " + tag, std::string("*")}) {
            const Response same = ask("GET", path, {{"if-none-match", field}});
            EXPECT_EQ(same.status, 304) << path << " " << field;
            EXPECT_EQ(same.body, "");
            EXPECT_EQ(header(same, "ETag"), tag);
        }
        EXPECT_EQ(ask("GET", path, {{"if-none-match", "\"x\""}}).status, 200) << path;
        EXPECT_EQ(ask("GET", path, {{"if-none-match", "x"}}).status, 400) << path;
        EXPECT_EQ(ask("GET", path, {{"if-match", "\"x\""}}).status, 412) << path;
        EXPECT_EQ(ask("GET", path, {{"if-match", tag}}).status, 200) << path;
    }
    EXPECT_EQ(ask("GET", session + "/polygons/p9", {{"if-none-match", "*"}}).status, 404);
    const std::string before = tag_of(session + "/mesh");
    ASSERT_EQ(post(session + "/polygons", kParcel).status, 200);
    EXPECT_EQ(ask("GET", session + "/mesh", {{"if-none-match", before}}).status, 200);
}

TEST_F(Conditions, HaveATagForEachRepresentation) {
    const std::string mesh = make_session() + "/mesh";
    std::set<std::string> tags;
    for (const char* query :
         {".json", ".glb", ".glb?up=z", ".glb?tolerance=0.01", ".glb?compression=none",
          ".glb?normals=false", ".glb?constraints=false", ".glb?compression=none&up=z"}) {
        tags.insert(tag_of(mesh + query));
    }
    EXPECT_EQ(tags.size(), 8U);
    EXPECT_EQ(tag_of(mesh + ".glb?up=y&tolerance=5e-3"), tag_of(mesh)) << "the same wishes";
    EXPECT_EQ(header(ask("GET", mesh), "Vary"), "Accept");
}

TEST_F(Conditions, RefuseWhatCannotBeRead) {
    const std::string path = make_session() + "/polygons";
    for (const char* bad : {"nonsense", "\"a", "w/\"a\"", "*, \"a\"", "'a'"}) {
        EXPECT_EQ(post(path, kParcel, {{"if-match", bad}}).status, 400) << bad;
    }
    EXPECT_EQ(post(path, kParcel, {{"if-match", "*"}}).status, 200);
}

TEST_F(Conditions, AreRequiredWhereTheOperatorWantsThem) {
    Services strict(few_sessions(), {.require_if_match = true, .cors_origins = {}});
    const Router strict_router(make_routes(strict));
    const auto send = [&](const std::string& method, const std::string& target,
                          std::vector<NameValue> headers, const std::string& body = {}) {
        const auto parsed = parse_target(target).value();
        headers.emplace_back("content-type", "application/json");
        Request request{method, parsed.path, parsed.query, std::move(headers), body, {}, "id"};
        return strict_router.handle(request);
    };
    const Response made = send("PUT", "/v1/sessions/s", {}, kSquare);
    ASSERT_EQ(made.status, 201) << made.body;
    const Response blind = send("POST", "/v1/sessions/s/polygons", {}, kParcel);
    EXPECT_EQ(blind.status, 428);
    EXPECT_EQ(told(blind), "precondition-required");
    const std::string tag = header(blind, "ETag");
    EXPECT_EQ(tag, header(made, "ETag"));
    EXPECT_EQ(send("POST", "/v1/sessions/s/polygons?dry_run=true", {}, kParcel).status, 200);
    EXPECT_EQ(send("POST", "/v1/sessions/s/polygons", {{"if-match", tag}}, kParcel).status, 200);
    EXPECT_EQ(send("DELETE", "/v1/sessions/s", {}).status, 428);
    EXPECT_EQ(send("DELETE", "/v1/sessions/s", {{"if-match", "*"}}).status, 200);
}

TEST_F(Conditions, KeepRacingClientsApart) {
    const std::string session = make_session();
    constexpr int kClients = 4;
    constexpr int kEdits = 10;
    std::atomic<int> refused{0};
    std::vector<std::thread> clients;
    for (int client = 0; client < kClients; ++client) {
        clients.emplace_back([&] {
            for (int done = 0; done < kEdits;) {
                const Response seen = ask("GET", session);
                const int version = json::parse(seen.body)["version"].get<int>();
                const Response answer =
                    post(session + "/polygons", kParcel, {{"if-match", header(seen, "ETag")}});
                if (answer.status == 412) {
                    ++refused;
                    continue;
                }
                ASSERT_EQ(answer.status, 200) << answer.body;
                EXPECT_EQ(json::parse(answer.body)["version"], version + 1)
                    << "an edit went in between what the client saw and what it changed";
                ++done;
            }
        });
    }
    for (std::thread& client : clients)
        client.join();
    EXPECT_EQ(version_of(session), 1 + kClients * kEdits);
}

TEST_F(Conditions, EncodeAMeshOnce) {
    const std::string session = make_session();
    const Response first = ask("GET", session + "/mesh.glb");
    const Response second = ask("GET", session + "/mesh");
    EXPECT_EQ(services.meshes.counts().encodings, 1U);
    EXPECT_EQ(second.body, first.body);
    EXPECT_EQ(header(second, "Tinsmith-Max-Error"), header(first, "Tinsmith-Max-Error"));
    EXPECT_EQ(header(second, "Tinsmith-Origin"), header(first, "Tinsmith-Origin"));
    EXPECT_EQ(ask("GET", session + "/mesh.json").body, ask("GET", session + "/mesh.json").body);
    EXPECT_EQ(services.meshes.counts().encodings, 2U);
    ask("GET", session + "/mesh", {{"if-none-match", "*"}});
    ask("GET", session + "/mesh.glb?up=z", {{"if-none-match", "*"}});
    EXPECT_EQ(services.meshes.counts().encodings, 2U) << "304 encodes nothing";
    ASSERT_EQ(post(session + "/polygons", kParcel).status, 200);
    EXPECT_NE(ask("GET", session + "/mesh").body, first.body);
    EXPECT_EQ(services.meshes.counts().encodings, 3U);
    EXPECT_EQ(ask("GET", session + "/mesh?tolerance=1e-12").status, 400);
    EXPECT_EQ(ask("GET", session + "/mesh?tolerance=1e-12").status, 400);
    EXPECT_EQ(services.meshes.counts().encodings, 5U) << "a refusal is not kept";
    ASSERT_EQ(ask("DELETE", session).status, 200);
    EXPECT_EQ(services.meshes.counts().bytes, 0U);
}

}  // namespace
}  // namespace tinsmith::server
