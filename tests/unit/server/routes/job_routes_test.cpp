// SPDX-License-Identifier: Apache-2.0
// Prefer: respond-async, as a client meets it.
#include <atomic>
#include <cmath>
#include <future>
#include <thread>

#include "server/log.hpp"
#include "tests/support/same_tin.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

const NameValue kAsync{"prefer", "respond-async"};

class JobRoutes : public Handlers {
  protected:
    void SetUp() override { set_log_level(LogLevel::Off); }
    void TearDown() override { set_log_level(LogLevel::Info); }

    json job(const std::string& where) { return json::parse(ask("GET", where).body); }

    /// Where the job of a request is; waits for its end.
    std::string finished(const Response& accepted) {
        EXPECT_EQ(accepted.status, 202) << accepted.body;
        const std::string where = header(accepted, "Location");
        for (std::string state; state != "done" && state != "failed" && state != "stopped";) {
            std::this_thread::yield();
            state = job(where)["state"];
        }
        return where;
    }

    /// Squares side by side, so many along an edge.
    static std::string grid(int side) {
        json elevations = json::array();
        for (int i = 0; i < (side + 1) * (side + 1); ++i)
            elevations.push_back(std::fmod(i * 0.618, 1.0));
        return json{{"grid",
                     {{"origin", {0, 0}},
                      {"cell", {1, 1}},
                      {"columns", side + 1},
                      {"rows", side + 1},
                      {"elevations", elevations}}}}
            .dump();
    }

    /// Many polygons, whose borders cross many edges.
    static std::string many_rings(int count, double side) {
        json features = json::array();
        for (int i = 0; i < count; ++i) {
            const double low = 0.3 + i * 0.01;
            const double high = side - 0.4 - i * 0.013;
            const json corner = json{low, low + 0.05};
            features.push_back(
                {{"type", "Feature"},
                 {"properties", nullptr},
                 {"geometry",
                  {{"type", "Polygon"},
                   {"coordinates",
                    {{corner, {high, low}, {high + 0.1, high}, {low, high - 0.2}, corner}}}}}});
        }
        return json{{"type", "FeatureCollection"}, {"features", features}}.dump();
    }
};

TEST_F(JobRoutes, AnswerAtOnceAndLater) {
    const Response accepted = post("/v1/sessions", kSquare, {kAsync});
    ASSERT_EQ(accepted.status, 202) << accepted.body;
    EXPECT_EQ(header(accepted, "Preference-Applied"), "respond-async");
    const std::string where = header(accepted, "Location");
    EXPECT_TRUE(where.starts_with("/v1/jobs/"));
    EXPECT_EQ("/v1/jobs/" + json::parse(accepted.body)["id"].get<std::string>(), where);
    finished(accepted);
    const json told_of = job(where);
    EXPECT_EQ(told_of["state"], "done");
    EXPECT_EQ(told_of["progress"], 1.0);
    EXPECT_EQ(told_of["status"], 201);
    EXPECT_EQ(told_of["result"], where + "/result");
    EXPECT_EQ(told_of["request"], json::parse(R"({"method": "POST", "path": "/v1/sessions"})"));
    const Response result = ask("GET", where + "/result");
    EXPECT_EQ(result.status, 201);
    EXPECT_EQ(ask("GET", header(result, "Location")).status, 200);
    EXPECT_EQ(ask("DELETE", where).status, 200);
    EXPECT_EQ(told(ask("GET", where)), "no-such-job");
    EXPECT_EQ(told(ask("GET", where + "/result")), "no-such-job");
    EXPECT_EQ(told(ask("DELETE", where)), "no-such-job");
}

TEST_F(JobRoutes, GiveTheVeryAnswer) {
    const std::string session = make_session();
    const Response fork = ask("POST", session + "/fork");
    const std::string other = header(fork, "Location");
    for (const NameValue& accept : {NameValue{"accept", "application/json"},
                                    {"accept", "model/gltf-binary"},
                                    {"accept", "application/vnd.tinsmith.delta"}}) {
        const Response direct = post(session + "/polygons", kParcel, {accept});
        const Response later = post(other + "/polygons", kParcel, {accept, kAsync});
        const Response result = ask("GET", finished(later) + "/result");
        EXPECT_EQ(result.status, direct.status);
        EXPECT_EQ(result.content_type, direct.content_type);
        EXPECT_EQ(header(result, "Tinsmith-Max-Error"), header(direct, "Tinsmith-Max-Error"));
        EXPECT_EQ(header(result, "Link"),
                  "<" + other + header(direct, "Link").substr(1 + session.size()));
        const bool is_report = accept.second == "application/json";  // names its session
        EXPECT_TRUE(is_report || result.body == direct.body);
    }
    const Response asked = post(session + "/volume", R"({"against": {"elevation": 1}})");
    const Response later = post(session + "/volume", R"({"against": {"elevation": 1}})", {kAsync});
    EXPECT_EQ(ask("GET", finished(later) + "/result").body, asked.body);
}

TEST_F(JobRoutes, TakePreferencesAsTheyAreWritten) {
    const std::string session = make_session();
    for (const char* text : {"respond-async", "Respond-Async", "wait=10, respond-async;x=y",
                             "handling=lenient,respond-async"}) {
        EXPECT_EQ(
            ask("POST", session + "/fork", {{"prefer", text}, {"accept", "image/png"}}).status,
            406);
        EXPECT_EQ(ask("POST", session + "/undo", {{"prefer", text}}).status, 202) << text;
    }
    for (const char* text : {"", "wait=10", "respond-asynchronously", "return=minimal"})
        EXPECT_EQ(ask("POST", session + "/undo", {{"prefer", text}}).status, 409) << text;
    EXPECT_EQ(ask("POST", "/v1/sessions/none/undo", {kAsync}).status, 404);
    for (const char* method : {"PUT", "DELETE"})
        EXPECT_EQ(told(ask(method, "/v1/sessions/none/locks", {kAsync})), "no-such-session");
    EXPECT_EQ(
        ask("PUT", "/v1/sessions/mine", {kAsync, {"content-type", "application/json"}}, kSquare)
            .status,
        202);
}

TEST_F(JobRoutes, TellFailures) {
    const std::string where = finished(post("/v1/sessions", "{", {kAsync}));
    EXPECT_EQ(job(where)["state"], "failed");
    EXPECT_EQ(job(where)["status"], 400);
    EXPECT_EQ(told(ask("GET", where + "/result")), "JSON_SYNTAX");
}

TEST_F(JobRoutes, AreOneForOneKey) {
    const std::string session = make_session();
    const NameValue key{"idempotency-key", "k"};
    const Response first = post(session + "/polygons", kParcel, {key, kAsync});
    const Response again = post(session + "/polygons", kParcel, {key, kAsync});
    EXPECT_EQ(again.status, 202);
    EXPECT_EQ(header(again, "Location"), header(first, "Location"));
    EXPECT_EQ(header(again, "Idempotency-Replayed"), "true");
    finished(first);
    EXPECT_EQ(version_of(session), 2);
}

TEST_F(JobRoutes, AreAskedForAnewWhereNothingCameOfThem) {
    const std::string session = make_session();
    const NameValue key{"idempotency-key", "k"};
    const Response failed =
        post(session + "/polygons", kParcel, {key, kAsync, {"if-match", "\"x\""}});
    EXPECT_EQ(job(finished(failed))["status"], 412);
    const Response again = post(session + "/polygons", kParcel, {key, kAsync});
    EXPECT_EQ(header(again, "Idempotency-Replayed"), "");
    EXPECT_EQ(job(finished(again))["status"], 200);
    EXPECT_EQ(version_of(session), 2);
    const Response third = post(session + "/polygons", kParcel, {key, kAsync});
    EXPECT_EQ(header(third, "Location"), header(again, "Location")) << "something came of it";
    EXPECT_EQ(services.answers.size(), 1U);
}

TEST_F(JobRoutes, ComeInPages) {
    const std::string session = make_session();
    for (int i = 0; i < 5; ++i)
        finished(ask("POST", session + "/undo", {kAsync}));
    std::size_t seen = 0;
    for (std::string page = "/v1/jobs?limit=2"; !page.empty();) {
        const Response part = ask("GET", page);
        seen += json::parse(part.body)["jobs"].size();
        const std::string link = header(part, "Link");
        page = link.empty() ? "" : link.substr(1, link.find('>') - 1);
    }
    EXPECT_EQ(seen, 5U);
}

TEST_F(JobRoutes, LeaveTheSessionAsItWasWhenStopped) {
    const Response made = post("/v1/sessions", grid(30));
    const std::string path = header(made, "Location");
    Session& session = *services.sessions.find(path.substr(13), {});
    post(path + "/polygons", kParcel);
    const core::Tin before = session.copy_tin();
    const std::string polygons = ask("GET", path + "/polygons").body;
    const std::string history = ask("GET", path + "/history").body;
    const std::string rings = many_rings(20, 30.0);
    // The work stops itself at a certain progress: in reading, in the march, in its swaps.
    for (const char* query : {"", "?improve=paper", "?dry_run=true"}) {
        for (const double end : {0.05, 0.2, 0.5, 0.7}) {
            Work* self = nullptr;
            Work work([&](double progress) {
                if (progress >= end) self->stop();
            });
            self = &work;
            const WorkScope scope(work);
            const Response stopped = post(path + "/polygons" + query, rings);
            EXPECT_EQ(stopped.status, 503) << end << query << stopped.body.substr(0, 200);
            EXPECT_LT(work.progress(), 0.95);
            EXPECT_TRUE(test::same_tin(session.copy_tin(), before)) << end << query;
        }
    }
    EXPECT_EQ(ask("GET", path + "/polygons").body, polygons);
    EXPECT_EQ(ask("GET", path + "/history").body, history);
    EXPECT_EQ(version_of(path), 2);
}

TEST_F(JobRoutes, StopBeforeASessionIsMade) {
    for (const double end : {0.01, 0.2, 0.39}) {
        Work* self = nullptr;
        Work work([&](double progress) {
            if (progress >= end) self->stop();
        });
        self = &work;
        const WorkScope scope(work);
        const Response stopped = post("/v1/sessions", grid(30));
        EXPECT_EQ(stopped.status, 503) << end << stopped.body;
        EXPECT_EQ(told(stopped), "STOPPED");
    }
    EXPECT_EQ(services.sessions.size(), 0U);
}

TEST_F(JobRoutes, ShowRealProgress) {
    const std::string path = header(post("/v1/sessions", grid(30)), "Location");
    std::vector<double> told_of;
    Work work([&told_of](double progress) { told_of.push_back(progress); });
    const WorkScope scope(work);
    ASSERT_EQ(post(path + "/polygons", many_rings(20, 30.0)).status, 200);
    EXPECT_TRUE(std::ranges::is_sorted(told_of));
    EXPECT_GT(std::ranges::count_if(told_of, [](double p) { return p > 0.15 && p < 0.8; }), 10);
}

TEST_F(JobRoutes, RaceTheirDeletion) {
    const std::string path = header(post("/v1/sessions", grid(20)), "Location");
    const std::string rings = many_rings(6, 20.0);
    int version = 1;
    for (int i = 0; i < 20; ++i) {
        const std::string where = header(post(path + "/polygons", rings, {kAsync}), "Location");
        for (int spin = 0; spin < i * 50; ++spin)
            std::this_thread::yield();
        const Response gone = ask("DELETE", where);
        ASSERT_EQ(gone.status, 200) << gone.body;
        const std::string state = json::parse(gone.body)["state"];
        // What it says is what became of it.
        if (state == "done") ++version;
        EXPECT_TRUE(state == "done" || state == "stopped") << state;
        EXPECT_EQ(version_of(path), version) << state;
    }
}

TEST(LargeJobs, AreRefusedForGood) {
    Limits limits;
    limits.job_bytes = 100;
    Services services{limits};
    const Router router{make_routes(services)};
    const Request request{
        "POST", "/v1/sessions", {}, {kAsync, {"content-type", "application/json"}}, kSquare,
        {},     "test"};
    const Response refused = router.handle(request);
    EXPECT_EQ(refused.status, 503);
    EXPECT_NE(refused.body.find("job_bytes"), std::string::npos);
    EXPECT_TRUE(std::ranges::none_of(
        refused.headers, [](const NameValue& header) { return header.first == "Retry-After"; }));
}

TEST_F(JobRoutes, AreNotDoneToASessionThatTookThePlaceOfTheirs) {
    const std::string session = "/v1/sessions/mine";
    const auto make = [&] {
        return ask("PUT", session, {{"content-type", "application/json"}}, kSquare).status;
    };
    ASSERT_EQ(make(), 201);
    std::promise<void> gate;
    const std::shared_future<void> opened = gate.get_future().share();
    for (std::size_t i = 0; i < Jobs::Bounds{}.threads; ++i) {
        ASSERT_TRUE(services.jobs.add({}, [opened](const Request&) {
            opened.wait();
            return Response{};
        }));
    }
    const Response waiting = post(session + "/polygons", kParcel, {kAsync});
    EXPECT_EQ(ask("DELETE", session).status, 200);
    ASSERT_EQ(make(), 201);
    gate.set_value();
    const std::string where = finished(waiting);
    EXPECT_EQ(job(where)["status"], 404);
    EXPECT_EQ(told(ask("GET", where + "/result")), "no-such-session");
    EXPECT_EQ(version_of(session), 1);
}

/// A server with room for one job.
class FewJobs : public testing::Test {
  protected:
    static Limits few() {
        Limits limits;
        limits.max_queued_jobs = 0;
        return limits;
    }
    Services services{few()};
    Router router{make_routes(services)};
};

TEST_F(FewJobs, SayWhenToComeAgain) {
    Request request{
        "POST",  "/v1/sessions",
        {},      {kAsync, {"content-type", "application/json"}, {"idempotency-key", "k"}},
        kSquare, {},
        "test"};
    const Response full = router.handle(request);
    EXPECT_EQ(full.status, 503);
    EXPECT_NE(full.body.find("too-many-jobs"), std::string::npos);
    EXPECT_TRUE(std::ranges::any_of(
        full.headers, [](const NameValue& header) { return header.first == "Retry-After"; }));
    EXPECT_EQ(services.sessions.size(), 0U);
    request.headers.erase(request.headers.begin());
    EXPECT_EQ(router.handle(request).status, 201) << "the key was not used up";
}

/// One key's jobs do not take the places of all.
TEST(JobsOfAKey, WaitAsFarAsItsQuotaGoes) {
    Limits limits;
    limits.job_threads = 1;
    Services services{limits};
    Router router{make_routes(services)};
    std::atomic<bool> is_held{true};
    const auto holds = [&is_held](const Request&) {
        while (is_held)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return Response{};
    };
    Request request{
        "POST", "/v1/sessions", {}, {kAsync, {"content-type", "application/json"}}, kSquare,
        {},     "test"};
    ASSERT_TRUE(services.jobs.add(request, holds));
    while (services.jobs.counts().running == 0)
        std::this_thread::yield();
    request.asker = {"01", "alice", {.max_queued_jobs = 2}};
    EXPECT_EQ(router.handle(request).status, 202);
    EXPECT_EQ(router.handle(request).status, 202);
    const Response full = router.handle(request);
    EXPECT_EQ(full.status, 429);
    EXPECT_EQ(full.problem, "too-many-requests");
    EXPECT_NE(full.body.find("quota max_queued_jobs of 2"), std::string::npos) << full.body;
    EXPECT_TRUE(std::ranges::any_of(
        full.headers, [](const NameValue& header) { return header.first == "Retry-After"; }));
    Request other = request;
    other.asker = {"02", "bob", {.max_queued_jobs = 1}};
    EXPECT_EQ(router.handle(other).status, 202);
    EXPECT_EQ(services.jobs.counts().queued, 3U);
    is_held = false;
    while (services.jobs.counts().queued > 0)
        std::this_thread::yield();
    EXPECT_EQ(router.handle(request).status, 202) << "there is room again";
}

}  // namespace
}  // namespace tinsmith::server
