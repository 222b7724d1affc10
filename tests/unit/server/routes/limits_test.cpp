// SPDX-License-Identifier: Apache-2.0
// Each limit and each quota is passed over a route: the refusal names it, and nothing of what was
// begun stays.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "server/keys/asker.hpp"
#include "server/turnstile.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

const std::string kSession = "/v1/sessions/s";

/// A grid of so many posts on a side, ten apart.
std::string grid(int side) {
    std::string text = R"({"grid": {"origin": [0,0], "cell": [10,10], "columns": )" +
                       std::to_string(side) + R"(, "rows": )" + std::to_string(side) +
                       R"(, "elevations": [)";
    for (int i = 0; i < side * side; ++i)
        text += (i == 0 ? "" : ",") + std::to_string(i % 7);
    return text + "]}}";
}

/// A ring around (45, 45).
std::string circle(int count) {
    std::string text = R"({"type": "Polygon", "coordinates": [[)";
    for (int i = 0; i <= count; ++i) {
        const double angle = 2 * 3.14159265358979 * (i % count) / count;
        text += (i == 0 ? "[" : ",[") + std::to_string(45 + 30 * std::cos(angle)) + "," +
                std::to_string(45 + 30 * std::sin(angle)) + "]";
    }
    return text + "]]}";
}

/// A server with limits of its own, and somebody who asks.
struct Server {
    explicit Server(Limits limits, Asker who = {})
        : services(limits), router(make_routes(services)), asker(std::move(who)) {}

    Response send(const std::string& method, const std::string& target,
                  const std::string& body = {}) {
        std::vector<NameValue> headers;
        if (!body.empty()) headers.emplace_back("content-type", "application/json");
        return ask(router, services, method, target, headers, body, [this](Request& request) {
            request.asker = asker;
            return std::nullopt;
        });
    }
    /// A session "s" of ten posts on a side.
    void make_session() { ASSERT_EQ(send("PUT", kSession, grid(10)).status, 201); }

    Services services;
    Router router;
    Asker asker;
};

/// Whether the answer names the limit, for people and for programs.
void expect_named(const Response& answer, int status, const std::string& problem,
                  const std::string& limit) {
    EXPECT_EQ(answer.status, status) << answer.body;
    EXPECT_EQ(answer.problem, problem) << answer.body;
    const json body = json::parse(answer.body);
    EXPECT_NE(body["detail"].get<std::string>().find(limit), std::string::npos) << answer.body;
    if (body.contains("errors")) {
        EXPECT_EQ(body["errors"][0].value("limit", ""), limit) << answer.body;
    }
}

/// What passes each limit that a quota may tighten. The server is new.
using Passing = void (*)(Server&);

void pass_max_vertices(Server& server) {
    expect_named(server.send("PUT", kSession, grid(11)), 413, "too-large", "max_vertices");
    expect_named(server.send(
                     "POST", "/v1/sessions",
                     R"({"points": [)" +
                         [] {
                             std::string text = "[0,0,0]";
                             for (int i = 1; i < 110; ++i)
                                 text +=
                                     ",[" + std::to_string(i) + "," + std::to_string(i * i) + ",0]";
                             return text;
                         }() +
                         "]}"),
                 413, "too-large", "max_vertices");
    EXPECT_EQ(server.services.sessions.size(), 0U);
    server.make_session();
}

void pass_max_triangles(Server& server) {
    expect_named(server.send("PUT", kSession, grid(15)), 413, "too-large", "max_triangles");
    server.make_session();
    const std::string before = server.send("GET", kSession + "/mesh.json").body;
    for (const char* query : {"", "?dry_run=true"}) {
        expect_named(server.send("POST", kSession + "/polygons" + query, circle(200)), 422,
                     "budget-exceeded", "max_triangles");
    }
    EXPECT_EQ(server.send("GET", kSession + "/mesh.json").body, before);
    EXPECT_EQ(server.send("POST", kSession + "/polygons", circle(5)).status, 200);
}

void pass_max_polygon_vertices(Server& server) {
    server.make_session();
    for (const char* path : {"/polygons", "/polygons?dry_run=true", "/profile"}) {
        expect_named(server.send("POST", kSession + path, circle(50)), 413, "too-large",
                     "max_polygon_vertices");
    }
    expect_named(server.send("PUT", kSession + "/locks", circle(50)), 413, "too-large",
                 "max_polygon_vertices");
    expect_named(server.send("POST", kSession + "/volume",
                             R"({"against": {"elevation": 1}, "polygon": )" + circle(50) + "}"),
                 413, "too-large", "max_polygon_vertices");
    EXPECT_EQ(server.send("POST", kSession + "/polygons", circle(49)).status, 200);
}

void pass_max_crossings(Server& server) {
    server.make_session();
    expect_named(server.send("POST", kSession + "/polygons",
                             R"({"type": "LineString", "coordinates": [[1,2],[89,77]]})"),
                 422, "budget-exceeded", "max_crossings");
    EXPECT_EQ(json::parse(server.send("GET", kSession).body)["version"], 1);
}

void pass_max_session_bytes(Server& server) {
    expect_named(server.send("PUT", kSession, grid(30)), 507, "out-of-memory", "max_session_bytes");
    EXPECT_EQ(server.services.sessions.size(), 0U);
    server.make_session();
    const auto most = static_cast<std::size_t>(
        within_quotas(server.services.limits, server.asker.quotas).max_session_bytes);
    const std::string before = server.send("GET", kSession + "/mesh.json").body;
    for (const char* query : {"", "?dry_run=true"}) {
        expect_named(server.send("POST", kSession + "/polygons" + query, circle(1000)), 422,
                     "budget-exceeded", "max_session_bytes");
    }
    EXPECT_EQ(server.send("GET", kSession + "/mesh.json").body, before);
    Response answer;
    for (int i = 0; i < 100 && answer.status == 200; ++i)
        answer = server.send("POST", kSession + "/polygons", circle(16 + i));
    expect_named(answer, 422, "budget-exceeded", "max_session_bytes");
    const std::size_t held = json::parse(server.send("GET", kSession).body)["memory_bytes"];
    EXPECT_GT(held, most / 2) << "there was room";
    EXPECT_LT(held, most + most / 4);
    expect_named(server.send("POST", kSession + "/edits",
                             R"({"operation": "set", "polygon": "p1", "elevation": 3})"),
                 422, "budget-exceeded", "max_session_bytes");
}

void pass_max_edit_seconds(Server& server) {
    server.make_session();
    EXPECT_EQ(server.services.limits_of(server.asker).max_edit_seconds, 1e-9);
    const Response answer = server.send("POST", kSession + "/polygons", circle(2000));
    EXPECT_EQ(answer.status, 503) << answer.body;
    EXPECT_NE(answer.body.find("max_edit_seconds"), std::string::npos) << answer.body;
    EXPECT_EQ(json::parse(server.send("GET", kSession).body)["version"], 1);
}

void pass_max_history(Server& server) {
    server.make_session();
    for (int i = 0; i < 5; ++i)
        EXPECT_EQ(server.send("POST", kSession + "/polygons", circle(5 + i)).status, 200);
    const json history = json::parse(server.send("GET", kSession + "/history").body);
    EXPECT_EQ(history["changes"].size(), 3U) << history;
    expect_named(server.send("DELETE", kSession + "/polygons/p3"), 409, "polygon-settled",
                 "max_history");
    EXPECT_EQ(server.send("GET", kSession + "/mesh.json?version=3").status, 410);
    EXPECT_EQ(server.send("POST", kSession + "/undo").status, 200);
    EXPECT_EQ(server.send("POST", kSession + "/undo").status, 200);
    EXPECT_EQ(server.send("POST", kSession + "/undo").status, 409);
}

/// The newest is kept, whatever it holds.
void pass_max_history_bytes(Server& server) {
    server.make_session();
    for (int i = 0; i < 5; ++i)
        EXPECT_EQ(server.send("POST", kSession + "/polygons", circle(5 + i)).status, 200);
    EXPECT_EQ(server.send("POST", kSession + "/undo").status, 200);
    EXPECT_EQ(server.send("POST", kSession + "/undo").status, 409);
}

void pass_max_points(Server& server) {
    server.make_session();
    expect_named(server.send("POST", kSession + "/elevation", R"({"points": [[1,1],[2,2],[3,3]]})"),
                 413, "too-large", "max_points");
    EXPECT_EQ(server.send("POST", kSession + "/elevation", R"({"points": [[1,1],[2,2]]})").status,
              200);
}

void pass_max_profile_crossings(Server& server) {
    server.make_session();
    expect_named(server.send("POST", kSession + "/profile",
                             R"({"type": "LineString", "coordinates": [[1,2],[89,77]]})"),
                 422, "budget-exceeded", "max_profile_crossings");
}

struct Row {
    const char* name;
    Limits limits;
    KeyQuotas quotas;
    Passing pass;
};

std::vector<Row> rows() {
    return {
        {"max_vertices", {.max_vertices = 100}, {.max_vertices = 100}, pass_max_vertices},
        {"max_triangles", {.max_triangles = 250}, {.max_triangles = 250}, pass_max_triangles},
        {"max_polygon_vertices",
         {.max_polygon_vertices = 50},
         {.max_polygon_vertices = 50},
         pass_max_polygon_vertices},
        {"max_crossings", {.max_crossings = 5}, {.max_crossings = 5}, pass_max_crossings},
        {"max_session_bytes",
         {.max_session_bytes = 40'000},
         {.max_session_bytes = 40'000},
         pass_max_session_bytes},
        {"max_edit_seconds",
         {.max_edit_seconds = 1e-9},
         {.max_edit_seconds = 1e-9},
         pass_max_edit_seconds},
        {"max_history", {.max_history = 2}, {.max_history = 2}, pass_max_history},
        {"max_history_bytes",
         {.max_history_bytes = 100},
         {.max_history_bytes = 100},
         pass_max_history_bytes},
        {"max_points", {.max_points = 2}, {.max_points = 2}, pass_max_points},
        {"max_profile_crossings",
         {.max_profile_crossings = 3},
         {.max_profile_crossings = 3},
         pass_max_profile_crossings},
    };
}

TEST(LimitRoutes, NameTheLimitThatWasMet) {
    for (const auto& [name, limits, quotas, pass] : rows()) {
        SCOPED_TRACE(name);
        Server server(limits);
        pass(server);
    }
}

TEST(LimitRoutes, HoldAKeyToItsOwn) {
    for (const auto& [name, limits, quotas, pass] : rows()) {
        SCOPED_TRACE(name);
        Server server({}, {"01", "alice", quotas});
        pass(server);
        // A quota tightens; it does not widen.
        Server other(limits, {"02", "bob", {}});
        pass(other);
        KeyQuotas wide;
        wide.max_vertices = wide.max_triangles = wide.max_polygon_vertices = SIZE_MAX;
        wide.max_session_bytes = SIZE_MAX;
        wide.max_crossings = UINT64_MAX;
        wide.max_edit_seconds = 1e9;
        wide.max_history = wide.max_history_bytes = wide.max_points = SIZE_MAX;
        wide.max_profile_crossings = UINT64_MAX;
        Server third(limits, {"03", "carol", wide});
        pass(third);
    }
}

/// A quota that is tightened later holds from the next change on; what is everyone's is not one
/// key's to forget.
TEST(LimitRoutes, BoundTheHistoryOfAKeysOwnSessions) {
    Server server({}, {"01", "alice", {}});
    server.make_session();
    for (int i = 0; i < 5; ++i)
        EXPECT_EQ(server.send("POST", kSession + "/polygons", circle(5 + i)).status, 200);
    const auto changes = [&server](const std::string& session) {
        return json::parse(server.send("GET", session + "/history").body)["changes"].size();
    };
    EXPECT_EQ(changes(kSession), 6U);
    const json fork = json::parse(server.send("POST", kSession + "/fork").body);
    const std::string copy = "/v1/sessions/" + fork["id"].get<std::string>();
    server.asker.quotas.max_history = 1;
    EXPECT_EQ(changes(kSession), 6U) << "nothing changed yet";
    EXPECT_EQ(server.send("POST", kSession + "/undo").status, 200);
    EXPECT_EQ(changes(kSession), 2U);
    EXPECT_EQ(server.send("POST", kSession + "/redo").status, 200);
    EXPECT_EQ(server.send("POST", kSession + "/polygons", circle(20)).status, 200);
    EXPECT_EQ(server.send("POST", kSession + "/undo").status, 200);
    EXPECT_EQ(server.send("POST", kSession + "/undo").status, 409);
    server.asker.quotas.max_history = 4;
    for (int i = 0; i < 5; ++i)
        EXPECT_EQ(server.send("POST", kSession + "/polygons", circle(30 + i)).status, 200);
    EXPECT_EQ(changes(kSession), 5U) << "and it may be widened";
    EXPECT_EQ(changes(copy), 6U);

    server.asker = {};
    const std::string shared = "/v1/sessions/everyones";
    EXPECT_EQ(server.send("PUT", shared, grid(10)).status, 201);
    server.asker = {"01", "alice", {.max_history = 1}};
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(server.send("POST", shared + "/polygons", circle(5 + i)).status, 200);
    EXPECT_EQ(changes(shared), 4U);
}

TEST(LimitRoutes, NameThoseOfForks) {
    Server server({.max_sessions = 2, .max_session_bytes = 40'000});
    server.make_session();
    EXPECT_EQ(server.send("POST", kSession + "/fork").status, 201);
    expect_named(server.send("POST", kSession + "/fork"), 429, "too-many-sessions", "max_sessions");
    // One that was made where more was allowed is there, and is not copied.
    server.asker = {"01", "alice", {.max_session_bytes = 1000}};
    expect_named(server.send("POST", kSession + "/fork"), 507, "out-of-memory",
                 "max_session_bytes");
    EXPECT_EQ(server.send("GET", kSession).status, 200);
}

TEST(Turnstile, LetsSoManyInAtATime) {
    Turnstile turnstile(2);
    const auto request_to = [](const std::string& path, const std::string& method = "GET") {
        Request request;
        request.method = method;
        request.path = path;
        return request;
    };
    auto first = std::make_unique<Request>(request_to("/v1/sessions"));
    first->pass = std::make_shared<const int>(1);
    const std::weak_ptr<const void> of_key = first->pass;
    EXPECT_FALSE(turnstile.admit(*first));
    Request second = request_to("/%761/sessions/s/polygons", "POST");
    EXPECT_FALSE(turnstile.admit(second));
    for (int i = 0; i < 3; ++i) {
        Request third = request_to("/v1/limits");
        const auto refusal = turnstile.admit(third);
        ASSERT_TRUE(refusal);
        EXPECT_EQ(refusal->status, 503);
        EXPECT_EQ(refusal->problem, "busy");
        EXPECT_NE(refusal->body.find("max_requests of 2"), std::string::npos);
        EXPECT_EQ(refusal->headers.front(), NameValue("Retry-After", "1"));
        EXPECT_FALSE(third.pass);
    }
    for (const char* open : {"/healthz", "/readyz", "/metrics", "/", "/openapi.json"}) {
        Request other = request_to(open);
        EXPECT_FALSE(turnstile.admit(other)) << open;
        EXPECT_FALSE(other.pass);
    }
    Request options = request_to("/v1/sessions", "OPTIONS");
    EXPECT_FALSE(turnstile.admit(options));
    auto copy = std::make_unique<Request>(*first);
    first.reset();
    Request third = request_to("/v1/limits");
    EXPECT_TRUE(turnstile.admit(third)) << "a job has a copy";
    EXPECT_FALSE(of_key.expired());
    copy.reset();
    EXPECT_TRUE(of_key.expired()) << "what it held beside its pass";
    EXPECT_FALSE(turnstile.admit(third));
}

}  // namespace
}  // namespace tinsmith::server
