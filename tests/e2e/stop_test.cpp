// SPDX-License-Identifier: Apache-2.0
// How the binary starts before its sessions are there, and how it ends: what is under way, within a
// time that has a bound, with exit code 0.
#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/e2e/program.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;
using std::chrono::seconds;

const std::string kJson = "Content-Type: application/json";
const std::string kSquare =
    R"({"mesh": {"vertices": [[0,0,0],[10,0,1],[10,10,2],[0,10,3]],
                 "triangles": [[0,1,2],[0,2,3]]}})";
/// What the process may take beyond the grace it was given (commands/stopping.hpp).
constexpr seconds kLastWait{5};
/// Of a machine that does other things too, and of sanitizers.
constexpr seconds kSlack{5};

/// Asks again until it is so; false after a minute.
template <typename Condition>
bool becomes_true(Condition condition) {
    const auto deadline = Clock::now() + seconds(60);
    while (!condition()) {
        if (Clock::now() > deadline) return false;
        std::this_thread::yield();
    }
    return true;
}

bool has_logged(const Program& program, const std::string& event) {
    return program.output().find("\"event\":\"" + event + "\"") != std::string::npos;
}

bool comes_to_log(const Program& program, const std::string& event) {
    return becomes_true([&] { return has_logged(program, event); });
}

/// So many posts along each side, up and down.
std::string large_grid(int side) {
    std::string grid = R"({"grid": {"origin": [0,0], "cell": [1,1], "columns": )" +
                       std::to_string(side) + R"(, "rows": )" + std::to_string(side) +
                       R"(, "elevations": [0)";
    for (int i = 1; i < side * side; ++i)
        grid += i % 3 == 0 ? ",1" : ",2.5";
    return grid + "]}}";
}

/// Lines from side to side of such a grid, each crossing many edges and many of the others.
std::string many_lines(int side, int count) {
    std::string lines = R"({"type": "MultiLineString", "coordinates": [)";
    for (int i = 0; i < count; ++i) {
        const double share = (i + 0.5) / count;
        const std::string low = std::to_string(share * (side - 1.0));
        const std::string high = std::to_string((1.0 - share * 0.9) * (side - 1.0));
        lines += std::string(i > 0 ? "," : "") + "[[0.3," + low + "],[" +
                 std::to_string(side - 1.4) + "," + high + "]]";
    }
    return lines + "]}";
}

json problem_of(const Answer& answer) {
    return json::parse(answer.body, nullptr, false);
}

/// A server that loads a terrain that does not come before `give`: the file is a pipe.
class StartingServer {
  public:
    explicit StartingServer(std::vector<std::string> arguments = {})
        : pipe_(scratch_.file("pipe")) {
        EXPECT_EQ(::mkfifo(pipe_.c_str(), 0600), 0);
        arguments.insert(arguments.begin(),
                         {"serve", "--port", "0", "--demo", "--demo-terrain", pipe_});
        program_.emplace(std::move(arguments), scratch_.file("log"));
        if (!comes_to_log(*program_, "listening")) return;
        const std::string log = program_->output();
        const std::size_t line = log.find("\"event\":\"listening\"");
        const std::size_t url = log.find("http://127.0.0.1:", line);
        port_ = std::atoi(log.substr(url + std::string("http://127.0.0.1:").size(), 5).c_str());
    }

    void give(const std::string& terrain = kSquare) const { write_content(pipe_, terrain); }
    int port() const { return port_; }
    Program& program() { return *program_; }

  private:
    ScratchDirectory scratch_;
    const std::string pipe_;
    std::optional<Program> program_;
    int port_ = 0;
};

TEST(ServiceStart, SaysNotReadyUntilTheSessionsAreThere) {
    StartingServer server;
    ASSERT_NE(server.port(), 0) << server.program().output();
    EXPECT_EQ(ask(server.port(), "GET", "/healthz").status, 200);
    EXPECT_EQ(ask(server.port(), "GET", "/metrics").status, 200);
    for (const char* path : {"/readyz", "/v1/sessions/demo"}) {
        const Answer early = ask(server.port(), "GET", path);
        EXPECT_EQ(early.status, 503);
        EXPECT_EQ(early.header("content-type"), "application/problem+json");
        EXPECT_EQ(early.header("retry-after"), "1");
        EXPECT_EQ(problem_of(early)["errors"][0]["code"], "STARTING") << early.body;
    }
    server.give();
    EXPECT_TRUE(becomes_true([&] { return ask(server.port(), "GET", "/readyz").status == 200; }));
    EXPECT_EQ(ask(server.port(), "GET", "/v1/sessions/demo").status, 200);
    server.program().send_signal(SIGTERM);
    EXPECT_EQ(server.program().wait(), 0) << server.program().output();
}

TEST(ServiceStart, FailsWhereTheTerrainIsNotThere) {
    const ScratchDirectory scratch;
    Program program({"serve", "--port", "0", "--demo", "--demo-terrain", scratch.file("none"),
                     "--drain-delay", "600", "--grace", "600"},
                    scratch.file("log"));
    EXPECT_EQ(program.wait(), 1) << program.output();
    EXPECT_TRUE(has_logged(program, "failed")) << program.output();
    EXPECT_NE(program.output().find("--demo: "), std::string::npos);
    EXPECT_FALSE(has_logged(program, "started"));
}

TEST(ServiceStart, FailsAsLoudlyWhileAClientTakesItsTime) {
    StartingServer server({"--grace", "600"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    const Connection slow(server.port());
    slow.send("POST /v1/sessions HTTP/1.1\r\nHost: x\r\nContent-Length: 500\r\n\r\n{");
    server.give("no terrain");
    EXPECT_EQ(server.program().wait(seconds(60)), 1) << server.program().output();
    EXPECT_TRUE(has_logged(server.program(), "failed")) << server.program().output();
}

TEST(ServiceStop, DoesNothingForSessionsThatWereNotLoaded) {
    StartingServer server({"--drain-delay", "600"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    server.program().send_signal(SIGTERM);
    ASSERT_TRUE(comes_to_log(server.program(), "draining"));
    for (const char* method : {"GET", "PUT", "DELETE"})
        EXPECT_EQ(ask(server.port(), method, "/v1/sessions/demo").status, 503) << method;
    server.program().send_signal(SIGTERM);
    EXPECT_EQ(server.program().wait(seconds(60)), 128 + SIGTERM);
}

TEST(ServiceStop, EndsInOrderWhereTheStartGivesUp) {
    StartingServer server;
    ASSERT_NE(server.port(), 0) << server.program().output();
    server.program().send_signal(SIGTERM);
    ASSERT_TRUE(comes_to_log(server.program(), "stopping"));
    server.give(content_of(std::string(TINSMITH_SOURCE_DIR) + "/tests/data/jacksboro.tif"));
    EXPECT_EQ(server.program().wait(seconds(60)), 0) << server.program().output();
    EXPECT_FALSE(has_logged(server.program(), "started")) << server.program().output();
    EXPECT_TRUE(has_logged(server.program(), "stopped")) << server.program().output();
}

TEST(ServiceStop, EndsAStartThatDoesNotEnd) {
    StartingServer server({"--grace", "0.2"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    const auto start = Clock::now();
    server.program().send_signal(SIGTERM);
    EXPECT_EQ(server.program().wait(seconds(60)), 0);
    EXPECT_LT(Clock::now() - start, seconds(1) + kLastWait + kSlack);
    EXPECT_TRUE(has_logged(server.program(), "stop_forced")) << server.program().output();
}

TEST(ServiceStop, ASecondSignalEndsItAtOnce) {
    StartingServer server({"--grace", "600"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    server.program().send_signal(SIGTERM);
    ASSERT_TRUE(comes_to_log(server.program(), "stopping"));
    EXPECT_TRUE(server.program().is_running());
    server.program().send_signal(SIGTERM);
    EXPECT_EQ(server.program().wait(seconds(60)), 128 + SIGTERM);
}

/// The system spares the first process of a container the signals that it does nothing about.
TEST(ServiceStop, ASecondSignalEndsTheFirstProcessOfAContainer) {
    if (std::system("unshare --pid --fork true 2>/dev/null") != 0)
        GTEST_SKIP() << "this system makes no process the first of its own";
    const ScratchDirectory scratch;
    const std::string first = scratch.file("first");
    const char* given = std::getenv("TINSMITH_PROGRAM");
    const std::string other = given != nullptr ? given : "";
    write_content(first, "#!/bin/sh\nexec unshare --pid --fork --kill-child '" +
                             (other.empty() ? std::string(TINSMITH_BINARY) : other) + "' \"$@\"\n");
    ASSERT_EQ(::chmod(first.c_str(), 0700), 0);
    ::setenv("TINSMITH_PROGRAM", first.c_str(), 1);
    StartingServer server({"--grace", "600"});
    other.empty() ? ::unsetenv("TINSMITH_PROGRAM") : ::setenv("TINSMITH_PROGRAM", other.c_str(), 1);
    ASSERT_NE(server.port(), 0) << server.program().output();
    const std::string outer = std::to_string(server.program().pid());
    const pid_t inner =
        std::atoi(content_of("/proc/" + outer + "/task/" + outer + "/children").c_str());
    ASSERT_GT(inner, 0);
    ::kill(inner, SIGTERM);
    ASSERT_TRUE(comes_to_log(server.program(), "stopping"));
    EXPECT_TRUE(server.program().is_running());
    ::kill(inner, SIGTERM);
    EXPECT_EQ(server.program().wait(seconds(60)), 128 + SIGTERM);
}

TEST(ServiceStop, SaysThatItDrainsWhileItStillListens) {
    ServerUnderTest server({"--drain-delay", "600"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    server.program().send_signal(SIGTERM);
    ASSERT_TRUE(comes_to_log(server.program(), "draining"));
    const Answer draining = ask(server.port(), "GET", "/readyz");
    EXPECT_EQ(draining.status, 503);
    EXPECT_EQ(draining.header("retry-after"), "1");
    EXPECT_EQ(problem_of(draining)["errors"][0]["code"], "DRAINING") << draining.body;
    const Answer served = ask(server.port(), "POST", "/v1/sessions", {kJson}, kSquare);
    EXPECT_EQ(served.status, 201) << "who comes all the same is served";
    EXPECT_EQ(served.header("connection"), "close");
    server.program().send_signal(SIGTERM);
    EXPECT_EQ(server.program().wait(), 128 + SIGTERM);
}

TEST(ServiceStop, AnswersWhatIsUnderWay) {
    ServerUnderTest server({"--grace", "600"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    Connection client(server.port());
    client.send("POST /v1/sessions HTTP/1.1\r\nHost: x\r\n" + kJson +
                "\r\nExpect: 100-continue\r\nContent-Length: " + std::to_string(kSquare.size()) +
                "\r\n\r\n");
    ASSERT_EQ(client.read().status, 100);
    client.send(kSquare.substr(0, 40));
    server.program().send_signal(SIGTERM);
    ASSERT_TRUE(comes_to_log(server.program(), "stopping"));
    // The listener is closed: nobody else gets in.
    EXPECT_TRUE(becomes_true([&] { return ask(server.port(), "GET", "/healthz").status == 0; }));
    EXPECT_TRUE(server.program().is_running());
    client.send(kSquare.substr(40));
    const Answer made = client.read();
    EXPECT_EQ(made.status, 201) << made.body;
    EXPECT_EQ(made.header("connection"), "close");
    EXPECT_EQ(server.program().wait(), 0) << server.program().output();
    EXPECT_TRUE(has_logged(server.program(), "stopped"));
}

TEST(ServiceStop, LetsEditsGiveUpAfterTheGrace) {
    constexpr int kSide = 700;
    ServerUnderTest server({"--grace", "0"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    const std::string session =
        ask(server.port(), "POST", "/v1/sessions", {kJson}, large_grid(kSide)).header("location");
    ASSERT_NE(session, "");
    Connection client(server.port());
    client.send(request_text("POST", session + "/polygons?improve=paper", {kJson},
                             many_lines(kSide, 1500)));
    ASSERT_TRUE(becomes_true([&] {
        return ask(server.port(), "GET", "/metrics")
                   .body.find("tinsmith_http_requests_in_flight 2\n") != std::string::npos;
    }));
    const auto start = Clock::now();
    server.program().send_signal(SIGTERM);
    const Answer given_up = client.read();
    EXPECT_EQ(given_up.status, 503) << given_up.body.substr(0, 300);
    EXPECT_EQ(problem_of(given_up)["type"], "urn:tinsmith:problem:stopped");
    EXPECT_EQ(server.program().wait(), 0);
    EXPECT_LT(Clock::now() - start, kLastWait + kSlack);
    EXPECT_FALSE(has_logged(server.program(), "stop_forced")) << server.program().output();
}

TEST(ServiceStop, WaitsForNoIdleConnection) {
    ServerUnderTest server({"--grace", "600"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    std::vector<std::unique_ptr<Connection>> idle;
    for (int i = 0; i < 5; ++i) {
        idle.push_back(std::make_unique<Connection>(server.port()));
        idle.back()->send(request_text("GET", "/v1/limits"));
        EXPECT_EQ(idle.back()->read().status, 200);
    }
    const Connection silent(server.port());
    const auto start = Clock::now();
    EXPECT_EQ(server.stop(), "");
    EXPECT_LT(Clock::now() - start, seconds(10) + kSlack) << "the keep-alive time bounds it";
}

TEST(ServiceStop, StopsJobsThatRunAndJobsThatWait) {
    ServerUnderTest server({"--job-threads", "1", "--grace", "600"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    const std::string session =
        ask(server.port(), "POST", "/v1/sessions", {kJson}, large_grid(500)).header("location");
    std::vector<std::string> jobs;
    for (int i = 0; i < 3; ++i) {
        const Answer accepted =
            ask(server.port(), "POST", session + "/polygons?improve=paper&dry_run=true",
                {kJson, "Prefer: respond-async"}, many_lines(500, 1000));
        ASSERT_EQ(accepted.status, 202) << accepted.body;
        jobs.push_back(accepted.header("location"));
    }
    const auto start = Clock::now();
    EXPECT_EQ(server.stop(), "");
    EXPECT_LT(Clock::now() - start, seconds(10) + kSlack);
    EXPECT_FALSE(has_logged(server.program(), "stop_forced"));
}

}  // namespace
}  // namespace tinsmith::e2e
