// SPDX-License-Identifier: Apache-2.0
// What an operator's programs ask: whether the server lives, whether it is ready, what it has done.
#include <future>
#include <optional>

#include "server/log.hpp"
#include "tests/support/prometheus_text.hpp"
#include "tests/unit/server/handlers.hpp"
#include "tests/unit/server/held_locks.hpp"

namespace tinsmith::server {
namespace {

using testing_support::PrometheusText;

/// Crosses the edge between the two triangles.
constexpr const char* kAcross =
    R"({"type": "Polygon", "coordinates": [[[1,2],[5,2],[5,7],[1,7],[1,2]]]})";

class ServiceRoutes : public Handlers {
  protected:
    void SetUp() override { set_log_level(LogLevel::Off); }
    void TearDown() override { set_log_level(LogLevel::Info); }

    PrometheusText scraped() {
        const Response response = ask("GET", "/metrics");
        EXPECT_EQ(response.status, 200);
        EXPECT_EQ(response.content_type, "text/plain; version=0.0.4; charset=utf-8");
        PrometheusText text(response.body);
        EXPECT_EQ(text.faults(), "");
        return text;
    }

    std::shared_ptr<Session> session_at(const std::string& path) {
        return services.sessions.find(path.substr(path.rfind('/') + 1), {});
    }

    /// The answer of another thread, if it comes while this one holds what `held` holds; a thread
    /// that waited would have it later.
    template <typename Held>
    std::optional<Response> answer_beside(std::optional<Held>& held, const std::string& path) {
        auto asked = std::async(std::launch::async, [this, path] { return ask("GET", path); });
        const bool came = asked.wait_for(std::chrono::seconds(20)) == std::future_status::ready;
        if (!came) held.reset();
        Response response = asked.get();
        return came ? std::optional(response) : std::nullopt;
    }
};

TEST_F(ServiceRoutes, HealthAndReadinessTakeNoLock) {
    const std::string path = make_session();
    const auto session = session_at(path);
    for (const char* asked : {"/healthz", "/readyz"}) {
        std::optional<AllLocksOf> locks(std::in_place, services, *session);
        const auto answer = answer_beside(locks, asked);
        ASSERT_TRUE(answer) << asked << " waits for a lock";
        EXPECT_EQ(answer->status, 200);
    }
}

TEST_F(ServiceRoutes, MetricsWaitForNoEdit) {
    const std::string path = make_session();
    const auto session = session_at(path);
    std::optional<EditOf> edit(std::in_place, *session);
    const auto answer = answer_beside(edit, "/metrics");
    ASSERT_TRUE(answer) << "the scrape waits for the edit";
    EXPECT_EQ(PrometheusText(answer->body).value("tinsmith_session_triangles"), 2);
}

TEST_F(ServiceRoutes, MetricsWaitForNoEncoding) {
    bool is_asked = false;
    services.meshes.get({"birth", 1, "-glb"}, [&]() -> MeshCache::Found {
        std::optional<int> nothing;
        is_asked = answer_beside(nothing, "/metrics").has_value();
        return nullptr;
    });
    EXPECT_TRUE(is_asked);
}

TEST_F(ServiceRoutes, MetricsTellWhatWasDoneAndWhatThereIs) {
    const std::string path = make_session();
    const NameValue key{"idempotency-key", "once"};
    const auto report = json::parse(post(path + "/polygons", kAcross, {key}).body);
    EXPECT_EQ(post(path + "/polygons", kAcross, {key}).status, 200);
    EXPECT_EQ(ask("POST", path + "/undo").status, 200);
    EXPECT_EQ(ask("POST", path + "/redo").status, 200);
    for (const char* mesh : {"/mesh.glb", "/mesh.glb", "/mesh.obj", "/mesh.xml"})
        EXPECT_EQ(ask("GET", path + mesh).status, 200);
    const PrometheusText text = scraped();
    const auto of_report = [&](const char* name) { return report["totals"][name].get<double>(); };
    EXPECT_EQ(text.value("tinsmith_crossings_total"), of_report("crossings"));
    EXPECT_GT(of_report("crossings"), 0);
    EXPECT_EQ(text.value("tinsmith_vertices_added_total"), of_report("vertices_added"));
    EXPECT_EQ(text.value("tinsmith_triangles_added_total"), of_report("triangles_added"));
    EXPECT_EQ(text.value(R"(tinsmith_edits_total{sort="polygons"})"), 1);
    EXPECT_EQ(text.value(R"(tinsmith_edits_total{sort="undo"})"), 1);
    EXPECT_EQ(text.value(R"(tinsmith_edits_total{sort="redo"})"), 1);
    EXPECT_EQ(text.value(R"(tinsmith_edit_stage_seconds_count{stage="integrate"})"), 1);
    EXPECT_EQ(text.value("tinsmith_answers_replayed_total"), 1);
    EXPECT_EQ(text.value("tinsmith_kept_answers"), 1);
    EXPECT_EQ(text.value("tinsmith_mesh_cache_hits_total"), 1);
    EXPECT_EQ(text.value("tinsmith_mesh_cache_misses_total"), 3);
    EXPECT_EQ(text.value(R"(tinsmith_encode_seconds_count{compression="draco",format="glb"})"), 1);
    EXPECT_EQ(text.value(R"(tinsmith_encode_seconds_count{compression="none",format="landxml"})"),
              1);
    EXPECT_EQ(text.value("tinsmith_sessions"), 1);
    EXPECT_EQ(text.value("tinsmith_sessions_max"), 3);
    EXPECT_EQ(text.value("tinsmith_session_triangles"),
              json::parse(ask("GET", path).body)["triangles"].get<double>());
    EXPECT_EQ(text.value("tinsmith_session_memory_bytes"),
              json::parse(ask("GET", path).body)["memory_bytes"].get<double>());
    EXPECT_EQ(text.value("tinsmith_jobs_queued"), 0);
    EXPECT_EQ(text.value("tinsmith_ready"), 1);
    EXPECT_EQ(text.value("tinsmith_build_info{version=\"0.1.0\"}"), 1);
    EXPECT_GT(text.value("process_resident_memory_bytes"), 0);
    EXPECT_GT(text.value("process_start_time_seconds"), 0);
    EXPECT_EQ(ask("DELETE", path).status, 200);
    EXPECT_EQ(scraped().value("tinsmith_sessions"), 0);
}

TEST_F(ServiceRoutes, AnswersAreCountedByTheirPattern) {
    const std::string path = make_session();
    const Router counted(make_routes(services), &services.metrics);
    const auto pattern = [&](const std::string& method, const std::string& target) {
        Request request;
        request.method = method;
        request.path = target;
        const Response response = counted.handle(request);
        return response.route != nullptr ? response.route->pattern() : "none";
    };
    EXPECT_EQ(pattern("GET", path), "/v1/sessions/{id}");
    EXPECT_EQ(pattern("GET", "/v1/sessions/gone/mesh.glb"), "/v1/sessions/{id}/mesh.glb");
    EXPECT_EQ(pattern("BREW", path), "/v1/sessions/{id}");
    EXPECT_EQ(pattern("OPTIONS", "/healthz"), "/healthz");
    EXPECT_EQ(pattern("GET", "/v1/sessions/%zz"), "none");
    EXPECT_EQ(pattern("GET", "/admin"), "none");
}

TEST_F(ServiceRoutes, SayNotReadyWhileTheServerStarts) {
    services.readiness.begin();
    for (const char* path : {"/readyz", "/v1/sessions", "/v1/sessions/demo/mesh.glb", "/v1/jobs"}) {
        const Response response = ask("GET", path);
        EXPECT_EQ(response.status, 503) << path;
        EXPECT_EQ(told(response), "STARTING");
        EXPECT_EQ(json::parse(response.body)["type"], "urn:tinsmith:problem:not-ready");
        EXPECT_EQ(header(response, "Retry-After"), "1");
    }
    EXPECT_EQ(post("/v1/sessions", kSquare).status, 503);
    for (const char* path : {"/healthz", "/v1/limits", "/openapi.json", "/"})
        EXPECT_EQ(ask("GET", path).status, 200) << path;
    EXPECT_EQ(scraped().value("tinsmith_ready"), 0);
    services.readiness.enter(Readiness::Phase::Serving);
    EXPECT_EQ(ask("GET", "/readyz").body, "{\"status\":\"ready\"}\n");
    EXPECT_EQ(ask("GET", "/v1/sessions").status, 200);
}

TEST_F(ServiceRoutes, SayNotReadyWhileTheServerDrains) {
    const std::string path = make_session();
    services.readiness.enter(Readiness::Phase::Draining);
    EXPECT_EQ(told(ask("GET", "/readyz")), "DRAINING");
    EXPECT_EQ(ask("GET", path).status, 200) << "who still comes is served";
    services.readiness.enter(Readiness::Phase::Serving);
    EXPECT_EQ(told(ask("GET", "/readyz")), "DRAINING") << "there is no way back";
}

TEST_F(ServiceRoutes, SayNotReadyWhileACheckSaysNo) {
    std::optional<std::string> full;
    services.readiness.add("journal", [&full] { return full; });
    services.readiness.add("clock", []() -> std::optional<std::string> { return {}; });
    EXPECT_EQ(ask("GET", "/readyz").status, 200);
    full = "no space left in /data";
    const Response response = ask("GET", "/readyz");
    EXPECT_EQ(response.status, 503);
    EXPECT_EQ(told(response), "CHECK_FAILED");
    EXPECT_EQ(json::parse(response.body)["errors"][0]["detail"], "journal: no space left in /data");
    EXPECT_EQ(ask("GET", "/healthz").status, 200);
    EXPECT_EQ(scraped().value("tinsmith_ready"), 0);
    full.reset();
    EXPECT_EQ(ask("GET", "/readyz").status, 200);
    services.readiness.add(
        "broken", []() -> std::optional<std::string> { throw std::runtime_error("oops"); });
    EXPECT_EQ(told(ask("GET", "/readyz")), "CHECK_FAILED");
}

}  // namespace
}  // namespace tinsmith::server
