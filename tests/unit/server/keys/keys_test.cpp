// SPDX-License-Identifier: Apache-2.0
// Routes with API keys in front: who may ask, and who sees what.
#include <set>
#include <thread>

#include "server/keys/gate.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

const std::vector<std::string>& strangers() {
    static const std::vector<std::string> kFields{
        "Bearer tin_0000000000000000000000000000000000000000000000000000000000000000",
        "Bearer nonsense",
        "Bearer ",
        "Bearer",
        "",
        "Basic dGluOnRpbg==",
        std::string("Bearer \0\xff", 9),
        "Bearer " + std::string(5000, 'x')};
    return kFields;
}

class KeyRoutes : public Handlers {
  protected:
    KeyRoutes() {
        admit = [this](Request& request) { return gate.admit(request); };
    }

    static NameValue bearer(const std::string& key) { return {"authorization", "Bearer " + key}; }

    Response as(const std::string& key, const std::string& method, const std::string& target,
                const std::string& body = {}, std::vector<NameValue> headers = {}) {
        headers.push_back(bearer(key));
        if (!body.empty()) headers.emplace_back("content-type", "application/json");
        return ask(method, target, std::move(headers), body);
    }

    /// A session of that key with one polygon.
    std::string make(const std::string& key, const std::string& id) {
        EXPECT_EQ(as(key, "PUT", "/v1/sessions/" + id, kSquare).status, 201);
        EXPECT_EQ(as(key, "POST", "/v1/sessions/" + id + "/polygons", kParcel).status, 200);
        return "/v1/sessions/" + id;
    }

    /// "/v1/sessions/{id}/polygons/{pid}" of that session.
    static std::string filled(std::string pattern, const std::string& id) {
        for (const auto& [name, value] : std::vector<NameValue>{
                 {"{id}", id}, {"{pid}", "p1"}, {"{version}", "2"}, {"{file}", "page.css"}}) {
            const std::size_t at = pattern.find(name);
            if (at != pattern.npos) pattern.replace(at, name.size(), value);
        }
        return pattern;
    }

    const std::string alice = new_key(), bob = new_key();
    KeyRing ring{
        {{"alice", "01", hash_of_key(alice), "", {}}, {"bob", "02", hash_of_key(bob), "", {}}}};
    Gate gate{ring};
};

TEST_F(KeyRoutes, AreWantedByEveryRouteUnderV1) {
    std::size_t kept = 0, open = 0;
    for (const Route& route : make_routes(services)) {
        const std::string target = filled(route.pattern, "square");
        const bool is_kept = route.pattern.starts_with("/v1/") || route.pattern == "/metrics";
        ++(is_kept ? kept : open);
        const Response without = ask(route.method, target);
        EXPECT_EQ(without.status == 401, is_kept) << route.method << " " << route.pattern;
        EXPECT_NE(as(alice, route.method, target).status, 401) << route.pattern;
        if (!is_kept) continue;
        EXPECT_EQ(told(without), "api-key-required");
        EXPECT_EQ(header(without, "WWW-Authenticate"), "Bearer realm=\"tinsmith\"");
        std::set<std::string> answers;
        for (const std::string& field : strangers()) {
            const Response refused = ask(route.method, target, {{"authorization", field}});
            EXPECT_EQ(refused.status, 401) << field;
            EXPECT_EQ(header(refused, "WWW-Authenticate"),
                      "Bearer realm=\"tinsmith\", error=\"invalid_token\"");
            answers.insert(refused.body);
        }
        EXPECT_EQ(answers.size(), 1U) << "unknown and malformed keys are refused in one way";
        EXPECT_EQ(ask(route.method, target, {bearer(alice), bearer(bob)}).status, 401);
        EXPECT_EQ(ask("OPTIONS", target).status, 200) << "browsers ask before they may show a key";
        if (route.method == "GET") {
            EXPECT_EQ(ask("HEAD", target).status, 401);
        }
    }
    EXPECT_GT(kept, 30U);
    EXPECT_GE(open, 6U);
}

TEST_F(KeyRoutes, AreWantedWhateverThePathLooksLike) {
    for (const char* target : {"/%761/sessions", "/v%31/sessions", "/v1", "/v1/", "/v1/nothing",
                               "/v1/sessions/a%2Fb", "/%6detrics", "/v1//sessions"})
        EXPECT_EQ(ask("GET", target).status, 401) << target;
    EXPECT_EQ(ask("PATCH", "/v1/sessions").status, 401);
    // The router has nothing there, with a key or without.
    for (const char* target : {"//v1/sessions", "/./v1/sessions", "/V1/sessions", "/x/../v1"})
        EXPECT_EQ(ask("GET", target).status, 404) << target;
    EXPECT_EQ(as(alice, "GET", "/%761/sessions").status, 200);
    EXPECT_EQ(ask("GET", "/v1/sessions", {{"authorization", "bEARER   " + alice}}).status, 200);
}

/// The walk: no route that takes a session's id tells a session of another key from none at all.
TEST_F(KeyRoutes, MakeSessionsThatAreThereForNobodyElse) {
    const std::string hers = make(alice, "hers");
    make(bob, "his");
    const auto state = [&] {
        return as(alice, "GET", hers).body + as(alice, "GET", hers + "/history").body +
               as(alice, "GET", hers + "/mesh.json").body;
    };
    const std::string before = state();
    const std::vector<std::vector<NameValue>> manners{{},
                                                      {{"idempotency-key", "k"}},
                                                      {{"prefer", "respond-async"}},
                                                      {{"if-match", "*"}},
                                                      {{"if-none-match", "*"}}};
    std::size_t walked = 0;
    for (const Route& route : make_routes(services)) {
        if (!route.pattern.starts_with("/v1/sessions/{id}")) continue;
        ++walked;
        for (const auto& headers : manners) {
            for (const std::string body : {"", kParcel}) {
                const auto asked = [&](const std::string& id) {
                    Response response =
                        as(bob, route.method, filled(route.pattern, id), body, headers);
                    for (std::size_t at; (at = response.body.find(id)) != std::string::npos;)
                        response.body.replace(at, id.size(), "?");
                    return response;
                };
                const std::string title = route.method + " " + route.pattern;
                if (title == "PUT /v1/sessions/{id}") continue;  // below
                const Response foreign = asked("hers"), none = asked("nobodys");
                EXPECT_EQ(foreign.status, none.status) << title;
                // A DELETE that has a body is refused for that, whatever it names.
                EXPECT_EQ(foreign.status, !body.empty() && none.status == 400 ? 400 : 404) << title;
                EXPECT_EQ(foreign.body, none.body) << title;
                EXPECT_EQ(foreign.headers, none.headers) << title;
            }
        }
    }
    EXPECT_GE(walked, 28U);
    EXPECT_EQ(state(), before);
    EXPECT_EQ(as(alice, "DELETE", hers).status, 200);
}

TEST_F(KeyRoutes, TakeIdsForAll) {
    make(alice, "hers");
    make(bob, "his");
    const Response foreign = as(bob, "PUT", "/v1/sessions/hers", kSquare);
    const Response own = as(bob, "PUT", "/v1/sessions/his", kSquare);
    EXPECT_EQ(told(foreign), "id-taken");
    EXPECT_EQ(json::parse(foreign.body)["detail"], json::parse(own.body)["detail"]);
    EXPECT_EQ(as(alice, "GET", "/v1/sessions/hers").status, 200);
}

TEST_F(KeyRoutes, ListWhatIsTheirsAndWhatIsNobodys) {
    make(alice, "hers");
    make(bob, "his");
    ASSERT_EQ(services.sessions.fork(*services.sessions.find("his", {}), {}).index(), 0U);
    const auto ids = [this](const std::string& key) {
        std::set<std::string> found;
        const json list = json::parse(as(key, "GET", "/v1/sessions").body);
        for (const auto& session : list["sessions"])
            found.insert(session["id"]);
        return found;
    };
    EXPECT_EQ(ids(alice).size(), 2U);
    EXPECT_TRUE(ids(alice).contains("hers"));
    EXPECT_FALSE(ids(alice).contains("his"));
    // One at a time, no page is empty for what it passes over.
    const Response page = as(bob, "GET", "/v1/sessions?limit=1");
    EXPECT_EQ(json::parse(page.body)["sessions"].size(), 1U);
    EXPECT_NE(header(page, "Link"), "");
}

TEST_F(KeyRoutes, CompareNoSurfacesWithThoseOfOthers) {
    make(alice, "hers");
    make(bob, "his");
    const auto against = [this](const std::string& key, const std::string& id) {
        return as(key, "POST", "/v1/sessions/his/volume",
                  R"({"polygon": "p1", "against": {"session": ")" + id + R"("}})");
    };
    const Response foreign = against(bob, "hers"), none = against(bob, "nine");
    EXPECT_EQ(told(foreign), "NO_SUCH_SESSION");
    EXPECT_EQ(foreign.status, none.status);
    EXPECT_EQ(told(none), told(foreign));
    EXPECT_EQ(against(bob, "his").status, 200);
}

TEST_F(KeyRoutes, ForkToTheForker) {
    make(alice, "hers");
    const auto hers = services.sessions.find("hers", {});
    const std::string shared = std::get<0>(services.sessions.fork(*hers, {}))->facts().id;
    const Response forked = as(bob, "POST", "/v1/sessions/" + shared + "/fork");
    ASSERT_EQ(forked.status, 201) << forked.body;
    EXPECT_EQ(as(bob, "GET", header(forked, "Location")).status, 200);
    EXPECT_EQ(as(alice, "GET", header(forked, "Location")).status, 404);
}

TEST_F(KeyRoutes, HaveJobsOfTheirOwn) {
    make(alice, "hers");
    const Response accepted = as(alice, "POST", "/v1/sessions/hers/elevation",
                                 R"({"points": [[1,1]]})", {{"prefer", "respond-async"}});
    ASSERT_EQ(accepted.status, 202) << accepted.body;
    const std::string job = header(accepted, "Location");
    std::size_t walked = 0;
    for (const Route& route : make_routes(services)) {
        if (!route.pattern.starts_with("/v1/jobs/{id}")) continue;
        ++walked;
        const std::string target = job + route.pattern.substr(std::string("/v1/jobs/{id}").size());
        const Response foreign = as(bob, route.method, target);
        EXPECT_EQ(foreign.status, 404) << route.pattern;
        EXPECT_EQ(told(foreign), "no-such-job");
    }
    EXPECT_EQ(walked, 3U);
    EXPECT_EQ(json::parse(as(bob, "GET", "/v1/jobs").body)["jobs"].size(), 0U);
    EXPECT_EQ(json::parse(as(alice, "GET", "/v1/jobs").body)["jobs"].size(), 1U);
    for (int i = 0; i < 1000 && as(alice, "GET", job + "/result").status == 409; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(as(alice, "GET", job + "/result").status, 200);
    EXPECT_EQ(as(alice, "DELETE", job).status, 200);
}

/// A job asks on a thread of its own, and still for the key that it belongs to.
TEST_F(KeyRoutes, MakeSessionsByJobsToo) {
    const Response accepted =
        as(alice, "PUT", "/v1/sessions/later", kSquare, {{"prefer", "respond-async"}});
    ASSERT_EQ(accepted.status, 202);
    const std::string result = header(accepted, "Location") + "/result";
    for (int i = 0; i < 1000 && as(alice, "GET", result).status == 409; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(as(alice, "GET", "/v1/sessions/later").status, 200);
    EXPECT_EQ(as(bob, "GET", "/v1/sessions/later").status, 404);
}

TEST_F(KeyRoutes, ReplayNoAnswersOfOthers) {
    const std::vector<NameValue> key{{"idempotency-key", "same"}};
    const Response hers = as(alice, "POST", "/v1/sessions", kSquare, key);
    const Response his = as(bob, "POST", "/v1/sessions", kSquare, key);
    EXPECT_EQ(his.status, 201);
    EXPECT_EQ(header(his, "Idempotency-Replayed"), "");
    EXPECT_NE(header(his, "Location"), header(hers, "Location"));
    EXPECT_EQ(header(as(alice, "POST", "/v1/sessions", kSquare, key), "Location"),
              header(hers, "Location"));
    // In a session that is nobody's both may change something under one key.
    ASSERT_EQ(
        services.sessions.fork(*services.sessions.find(header(hers, "Location").substr(13), {}), {})
            .index(),
        0U);
    std::string shared;
    const json list = json::parse(as(bob, "GET", "/v1/sessions").body);
    for (const auto& session : list["sessions"])
        if ("/v1/sessions/" + session["id"].get<std::string>() != header(his, "Location"))
            shared = "/v1/sessions/" + session["id"].get<std::string>() + "/polygons";
    EXPECT_EQ(as(alice, "POST", shared, kParcel, key).status, 200);
    const Response second = as(bob, "POST", shared, kParcel, key);
    EXPECT_EQ(second.status, 200);
    EXPECT_EQ(header(second, "Idempotency-Replayed"), "");
    EXPECT_EQ(header(as(bob, "POST", shared, kParcel, key), "Idempotency-Replayed"), "true");
}

TEST_F(KeyRoutes, HaveQuotasThatRefusalsName) {
    const std::string carol = new_key(), dave = new_key();
    ring.replace({{"carol", "03", hash_of_key(carol), "", {.max_sessions = 1}},
                  {"dave", "04", hash_of_key(dave), "", {.max_memory_bytes = 10'000}},
                  {"alice", "01", hash_of_key(alice), "", {}}});
    make(carol, "one");
    for (const Response& refused :
         {as(carol, "PUT", "/v1/sessions/two", kSquare), as(carol, "POST", "/v1/sessions", kSquare),
          as(carol, "POST", "/v1/sessions/one/fork")}) {
        EXPECT_EQ(refused.status, 429);
        EXPECT_EQ(told(refused), "too-many-sessions");
        EXPECT_NE(refused.body.find("quota max_sessions of this key, 1,"), std::string::npos);
    }
    EXPECT_EQ(as(alice, "PUT", "/v1/sessions/two", kSquare).status, 201);
    EXPECT_EQ(as(carol, "DELETE", "/v1/sessions/one").status, 200);
    EXPECT_EQ(as(carol, "PUT", "/v1/sessions/one", kSquare).status, 201);

    ASSERT_EQ(as(dave, "PUT", "/v1/sessions/small", kSquare).status, 201);
    Response refused;
    for (int i = 0; i < 1000 && refused.status == 200; ++i)
        refused = as(dave, "POST", "/v1/sessions/small/polygons", kParcel);
    EXPECT_EQ(refused.status, 507);
    EXPECT_NE(refused.body.find("quota max_memory_bytes of 10000"), std::string::npos);
    refused = as(dave, "POST", "/v1/sessions/small/fork");
    EXPECT_EQ(told(refused), "out-of-memory");
    EXPECT_NE(refused.body.find("quota max_memory_bytes of 10000"), std::string::npos);
    EXPECT_EQ(as(dave, "DELETE", "/v1/sessions/small").status, 200);
}

TEST_F(KeyRoutes, HaveALongestBodyThatIsJudgedByItsHead) {
    const std::string carol = new_key();
    ring.replace({{"carol", "03", hash_of_key(carol), "", {.max_body_bytes = 100}},
                  {"alice", "01", hash_of_key(alice), "", {}}});
    Request head;
    head.method = "POST";
    head.path = "/v1/sessions";
    head.headers = {bearer(carol), {"content-length", "101"}};
    const auto refused = gate.admit(head);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->status, 413);
    EXPECT_NE(refused->body.find("quota max_body_bytes of this key is 100"), std::string::npos);
    head.headers[1].second = "100";
    EXPECT_FALSE(gate.admit(head));
    head.headers = {bearer(alice), {"content-length", "101"}};
    EXPECT_FALSE(gate.admit(head));
}

TEST_F(KeyRoutes, AreToldTheirOwnLimits) {
    const std::string carol = new_key();
    ring.replace({{"carol",
                   "03",
                   hash_of_key(carol),
                   "",
                   {10, 20, 30, 2.5, 40, 50, 60, 70, 80, 90, 0.5, 100, 110, 120, 130, 140}},
                  {"alice", "01", hash_of_key(alice), "", {}}});
    EXPECT_EQ(json::parse(as(carol, "GET", "/v1/limits").body)["key"],
              json::parse(R"({"name": "carol", "id": "03", "max_sessions": 10,
                              "max_memory_bytes": 20, "max_requests": 30,
                              "max_requests_per_second": 2.5, "max_body_bytes": 40,
                              "max_session_bytes": 50, "max_vertices": 60, "max_triangles": 70,
                              "max_polygon_vertices": 80, "max_crossings": 90,
                              "max_edit_seconds": 0.5, "max_history": 100,
                              "max_history_bytes": 110, "max_points": 120,
                              "max_profile_crossings": 130, "max_queued_jobs": 140})"));
    EXPECT_EQ(json::parse(as(alice, "GET", "/v1/limits").body)["key"],
              json::parse(R"({"name": "alice", "id": "01"})"));
    const json described = json::parse(
        api::openapi_document())["components"]["schemas"]["Limits"]["properties"]["key"];
    std::set<std::string> names;
    for (const auto& [name, schema] : described["properties"].items())
        names.insert(name);
    const json told = json::parse(as(carol, "GET", "/v1/limits").body)["key"];
    for (const auto& [name, value] : told.items())
        EXPECT_EQ(names.erase(name), 1U) << name;
    EXPECT_TRUE(names.empty());
}

}  // namespace
}  // namespace tinsmith::server
