// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "tests/support/random_input.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

class VersionRoutes : public Handlers {
  protected:
    std::string session = make_session();

    std::string mesh(const std::string& query = {}) {
        const Response answer = ask("GET", session + "/mesh.json" + query);
        return answer.status == 200 ? answer.body : told(answer);
    }
    std::string mesh_at(int version) { return mesh("?version=" + std::to_string(version)); }

    void remember() { meshes_[version_of(session)] = mesh(); }
    /// Every version is still what it was.
    void expect_all() {
        for (const auto& [version, was] : meshes_)
            ASSERT_EQ(mesh_at(version), was) << "version " << version;
    }

    static std::string ring(double low, double high) {
        const json position = [](double x, double y) { return json{x, y}; }(low, low);
        return json{{"type", "Polygon"},
                    {"coordinates", {{position, {high, low}, {high, high}, {low, high}, position}}}}
            .dump();
    }

    std::map<int, std::string> meshes_;
};

TEST_F(VersionRoutes, SendTheMeshAsItWas) {
    remember();
    post(session + "/polygons", ring(1, 4));
    remember();
    post(session + "/polygons", ring(3, 6));
    remember();
    expect_all();
    const Response was = ask("GET", session + "/mesh.json?version=2");
    const Response glb = ask("GET", session + "/mesh.glb?version=2&compression=none");
    ask("POST", session + "/undo");
    const Response now = ask("GET", session + "/mesh.json");
    EXPECT_EQ(now.body, was.body);
    EXPECT_NE(header(now, "ETag"), header(was, "ETag")) << "another version, if the same bytes";
    EXPECT_EQ(ask("GET", session + "/mesh.glb?compression=none").body, glb.body);
    EXPECT_EQ(ask("GET", session + "/mesh?version=2", {{"accept", "application/json"}}).body,
              was.body);
}

TEST_F(VersionRoutes, KeepWhatWasUndoneRemovedAndReplaced) {
    test::Random random(11);
    int edits = 0;
    remember();
    for (int i = 0; i < 300; ++i) {
        Response answer;
        switch (test::pick(random, 8)) {
            case 0:
                answer = ask("POST", session + "/undo");
                break;
            case 1:
                answer = ask("POST", session + "/redo");
                break;
            case 2: {
                const std::string some = "p" + std::to_string(1 + test::pick(random, i + 1));
                answer = ask("DELETE", session + "/polygons/" + some + "?cascade=true");
                break;
            }
            case 3: {
                const json edit{{"operation", "offset"},
                                {"polygon", "p" + std::to_string(1 + test::pick(random, i + 1))},
                                {"by", test::uniform(random, -1, 1)}};
                answer = post(session + "/edits", edit.dump());
                edits += answer.status == 200;
                break;
            }
            default: {
                const double low = test::uniform(random, 0, 8);
                answer =
                    post(session + "/polygons", ring(low, low + test::uniform(random, 0.2, 2.5)));
            }
        }
        if (answer.status == 200) remember();
        if (i % 20 == 0) expect_all();
    }
    EXPECT_GT(edits, 3);
    expect_all();
    const Response forked = ask("POST", session + "/fork");
    session = "/v1/sessions/" + json::parse(forked.body)["id"].get<std::string>();
    expect_all();
}

TEST_F(VersionRoutes, AnswerConditionsOfTheirOwn) {
    post(session + "/polygons", ring(1, 4));
    const std::string tag = header(ask("GET", session + "/mesh.json?version=1"), "ETag");
    EXPECT_EQ(ask("GET", session + "/mesh.json?version=1", {{"if-none-match", tag}}).status, 304);
    EXPECT_EQ(ask("GET", session + "/mesh.json", {{"if-none-match", tag}}).status, 200);
    const auto encodings = services.meshes.counts().encodings;
    ask("GET", session + "/mesh.json?version=1");
    EXPECT_EQ(services.meshes.counts().encodings, encodings) << "kept under its version";
}

TEST_F(VersionRoutes, RefuseWhatIsNotThere) {
    for (const char* none : {"0", "2", "99"})
        EXPECT_EQ(mesh("?version=" + std::string(none)), "no-such-version") << none;
    EXPECT_EQ(mesh("?version=x"), "INVALID_VALUE");
    EXPECT_EQ(mesh("?version=-1"), "INVALID_VALUE");
    EXPECT_EQ(told(ask("GET", session + "/mesh?since=1&version=1")), "INVALID_VALUE");
}

TEST_F(VersionRoutes, CompareVolumesWithAnEarlierOne) {
    post(session + "/polygons?elevation=own",
         R"({"type": "Polygon", "coordinates": [[[2,2,9],[5,2,9],[5,5,9],[2,5,9],[2,2,9]]]})");
    const Response answer = post(session + "/volume", R"({"against": {"version": 1}})");
    ASSERT_EQ(answer.status, 200) << answer.body;
    const json volume = json::parse(answer.body);
    EXPECT_EQ(volume["against"], json::parse(R"({"version": 1})"));
    EXPECT_GT(volume["cut"].get<double>(), 1.0);
    EXPECT_NEAR(volume["fill"].get<double>(), 0.0, 1e-9);
    ask("POST", session + "/undo");
    const json none = json::parse(post(session + "/volume", R"({"against": {"version": 1}})").body);
    EXPECT_EQ(none["cut"], 0.0);
    const json back = json::parse(post(session + "/volume", R"({"against": {"version": 2}})").body);
    EXPECT_NEAR(back["fill"].get<double>(), volume["cut"].get<double>(), 1e-9);
    const Response ahead = post(session + "/volume", R"({"against": {"version": 9}})");
    EXPECT_EQ(told(ahead), "no-such-version");
}

/// A server that keeps little.
class ForgetfulVersions : public VersionRoutes {
  protected:
    static Limits little() {
        Limits limits = few_sessions();
        limits.max_history = 3;
        return limits;
    }
    ForgetfulVersions() { session = make(); }

    std::string make() {
        const Response made = forgetful_router.handle(request_of("POST", "/v1/sessions", kSquare));
        return "/v1/sessions/" + json::parse(made.body)["id"].get<std::string>();
    }
    static Request request_of(const std::string& method, const std::string& target,
                              const std::string& body = {}) {
        auto parsed = parse_target(target).value();
        return {method, parsed.path, parsed.query, {{"content-type", "application/json"}},
                body,   {},          "test"};
    }

    Services forgetful{little()};
    Router forgetful_router{make_routes(forgetful)};
};

TEST_F(ForgetfulVersions, AreGoneAndNameTheOldest) {
    for (int i = 0; i < 6; ++i)
        forgetful_router.handle(request_of("POST", session + "/polygons", ring(1 + i, 1.5 + i)));
    const auto get = [&](int version) {
        return forgetful_router.handle(
            request_of("GET", session + "/mesh.json?version=" + std::to_string(version)));
    };
    const Response gone = get(3);
    EXPECT_EQ(gone.status, 410);
    EXPECT_NE(gone.body.find("The oldest kept is 4"), std::string::npos) << gone.body;
    for (int version = 4; version <= 7; ++version)
        EXPECT_EQ(get(version).status, 200) << version;
    const Response volume = forgetful_router.handle(
        request_of("POST", session + "/volume", R"({"against": {"version": 1}})"));
    EXPECT_EQ(volume.status, 410);
}

/// Copies count: of a server whose memory is full of sessions nothing more is asked.
TEST(CopyMemory, IsLimitedWithTheSessions) {
    Limits limits;
    limits.max_memory_bytes = 1000;
    SessionStore store(limits);
    {
        const auto first = store.borrow(600);
        ASSERT_TRUE(first);
        EXPECT_FALSE(store.borrow(600));
        EXPECT_EQ(store.memory_bytes(), 600U);
    }
    EXPECT_EQ(store.memory_bytes(), 0U);
    EXPECT_TRUE(store.borrow(1000));
}

}  // namespace
}  // namespace tinsmith::server
