// SPDX-License-Identifier: Apache-2.0
// The real HAProxy with docker/haproxy.cfg before the real server: refusals have the same form at
// the edge, and a well-behaved client hardly notices an attack.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <iostream>
#include <list>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "tests/attack/edge_problem.hpp"
#include "tests/attack/proxy.hpp"
#include "tests/attack/victim.hpp"
#include "tests/durability/bench_print.hpp"
#include "tests/durability/random_shapes.hpp"
#include "tests/durability/steady_client.hpp"

namespace tinsmith::e2e {
namespace {

using Clock = std::chrono::steady_clock;

const std::string kJson = "Content-Type: application/json";
const std::string kHonest = "/v1/sessions/honest";
constexpr int kDripping = 200;
/// On a machine that does nothing else; TINSMITH_EDGE_P99_MS has another one's.
constexpr double kMostMilliseconds = 50;
/// A test among others is no measurement: it only finds clients that were made to wait.
constexpr double kMostMillisecondsAmongOthers = 2000;

double most_milliseconds() {
    const char* text = std::getenv("TINSMITH_EDGE_P99_MS");
    if (text != nullptr) return std::atof(text);
    return is_long_form() ? kMostMilliseconds : kMostMillisecondsAmongOthers;
}

class Edge : public testing::Test {
  protected:
    void SetUp() override {
        if (Proxy::program().empty())
            GTEST_SKIP() << "haproxy is not installed (docker/packages/install.sh test)";
        victim_.emplace();
        ASSERT_NE(victim_->port(), 0);
        proxy_.emplace(victim_->port());
        ASSERT_NE(proxy_->port(), 0) << proxy_->output();
        victim_->watch_memory();
    }
    void TearDown() override {
        if (!proxy_ || proxy_->port() == 0) return;
        EXPECT_TRUE(proxy_->is_running()) << proxy_->output();
        EXPECT_EQ(victim_->harm_at_the_end(), "");
    }

    Answer send(const std::string& bytes) {
        Connection connection(proxy_->port());
        connection.send(bytes);
        return connection.read();
    }

    void expect_problem(const std::string& bytes, int status, const std::string& word) {
        SCOPED_TRACE(bytes.substr(0, 200));
        e2e::expect_problem(send(bytes), status, word);
    }

    static std::string post(const std::string& headers, const std::string& body = {}) {
        return "POST /v1/sessions HTTP/1.1\r\nHost: x\r\n" + kJson + "\r\n" + headers + "\r\n" +
               body;
    }
    static std::string get(const std::string& headers, const std::string& body = {}) {
        return "GET /v1/limits HTTP/1.1\r\nHost: x\r\n" + headers + "\r\n" + body;
    }

    std::optional<Victim> victim_;
    std::optional<Proxy> proxy_;
};

TEST_F(Edge, RefusesInTheSameForm) {
    expect_problem(post("Transfer-Encoding: chunked\r\n", "0\r\n\r\n"), 411, "length-required");
    expect_problem(post("Content-Length: 5\r\nContent-Encoding: gzip\r\n", "hello"), 415,
                   "unsupported-encoding");
    expect_problem(post("Content-Length: 25165825\r\nExpect: 100-continue\r\n"), 413, "too-large");
    // What HAProxy cannot read as HTTP it answers in a form of its own, which nothing changes.
    EXPECT_EQ(send(post("Content-Length: abc\r\n")).status, 400);
    EXPECT_EQ(send(post("Content-Length: 1\r\nContent-Length: 5\r\n", "hello")).status, 400);
    expect_problem(get("Content-Length: 5\r\n", "hello"), 400, "bad-request");
    expect_problem(get("Range: bytes=0-1,2-3\r\n"), 416, "range-refused");
    expect_problem("BREW / HTTP/1.1\r\nHost: x\r\n\r\n", 405, "method-not-allowed");
    expect_problem("CONNECT x:80 HTTP/1.1\r\nHost: x:80\r\n\r\n", 405, "method-not-allowed");
    expect_problem("GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n", 404, "no-such-path");
    EXPECT_EQ(send("nonsense\r\n\r\n").status, 400);
    std::string headers;
    for (int i = 0; i < 50'000; ++i)
        headers += "X-" + std::to_string(i) + ": " + std::string(1000, 'y') + "\r\n";
    EXPECT_EQ(send(get(headers)).status, 400);
    EXPECT_EQ(send(get("X-Long: " + std::string(std::size_t{32} << 20, 'a') + "\r\n")).status, 400);
}

TEST_F(Edge, LetsThroughWhatTheServerTakes) {
    Dice dice(5);
    const std::string session = "/v1/sessions/edge";
    const int port = proxy_->port();
    // Longer than the buffer, so by the way of long bodies.
    const std::string grid = grid_text(dice, 150);
    ASSERT_GT(grid.size(), 65536U);
    EXPECT_EQ(ask(port, "PUT", session, {kJson}, grid).status, 201);
    const std::string ring = polygon_text(ring_text(dice, 60, 60, 20, 12));
    EXPECT_EQ(ask(port, "POST", session + "/polygons", {kJson}, ring).status, 200);
    const Answer mesh = ask(port, "GET", session + "/mesh.glb");
    EXPECT_EQ(mesh.status, 200);
    EXPECT_EQ(mesh.body.substr(0, 4), "glTF");
    EXPECT_EQ(
        ask(port, "GET", session + "/mesh.glb", {"If-None-Match: " + mesh.header("etag")}).status,
        304);
    EXPECT_EQ(ask(port, "HEAD", session + "/mesh.glb").status, 200);
    EXPECT_EQ(ask(port, "OPTIONS", session).status, 200);
    EXPECT_EQ(ask(port, "PATCH", session, {kJson}, "{}").status, 405);
    const std::string line = R"({"type":"LineString","coordinates":[[10,10],[20,20]]})";
    const Answer locked = ask(port, "DELETE", session + "/locks", {kJson}, line);
    EXPECT_EQ(locked.status / 100, 2) << locked.body;
    EXPECT_EQ(ask(port, "DELETE", session).status, 200);
    // Forged addresses do not reach the server, the client's id of the request does.
    EXPECT_EQ(send(get("REMOTE_ADDR: 10.0.0.1\r\n")).status, 200);
    EXPECT_EQ(send(get("X-Request-Id: mine-1\r\n")).header("x-request-id"), "mine-1");
    EXPECT_NE(send(get("X-Request-Id: \"},{\r\n")).header("x-request-id"), "");

    Connection invited(port);
    invited.send(post("Content-Length: 2\r\nExpect: 100-continue\r\n"));
    EXPECT_EQ(invited.read().status, 100);
    invited.send("{}");
    EXPECT_EQ(invited.read().status, 422);
}

/// What an attacker does until it is told to stop.
class Attackers {
  public:
    explicit Attackers(int port) {
        threads_.emplace_back([this, port] {
            drip(port, "GET /v1/limits HTTP/1.1\r\nHost: x\r\n", "X-A: b\r\n", kDripping / 2);
        });
        threads_.emplace_back([this, port] {
            drip(port,
                 "POST /v1/sessions HTTP/1.1\r\nHost: x\r\n" + kJson +
                     "\r\nContent-Length: 50000\r\n\r\n",
                 " ", kDripping / 4);
        });
        // These fill the buffer first: they get as far as the server, by the way of long bodies.
        threads_.emplace_back([this, port] {
            drip(port,
                 "POST /v1/sessions HTTP/1.1\r\nHost: x\r\n" + kJson +
                     "\r\nContent-Length: 9000000\r\n\r\n" + std::string(70'000, ' '),
                 " ", kDripping / 4);
        });
        threads_.emplace_back([this, port] { send_the_table(port); });
    }
    ~Attackers() { stop_ = true; }
    Attackers(const Attackers&) = delete;
    Attackers& operator=(const Attackers&) = delete;

    int rounds() const { return rounds_; }

  private:
    void drip(int port, const std::string& head, const std::string& drop, int count) const {
        std::list<std::optional<Connection>> all(static_cast<std::size_t>(count));
        while (!stop_) {
            // Who was cut comes again.
            for (auto& connection : all) {
                if (connection && connection->try_send(drop)) continue;
                connection.emplace(port);
                connection->send(head);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(200));
        }
    }

    void send_the_table(int port) {
        const std::string post = "POST /v1/sessions HTTP/1.1\r\nHost: x\r\n" + kJson + "\r\n";
        const std::string get = "GET /v1/limits HTTP/1.1\r\nHost: x\r\n";
        const std::string mebi(std::size_t{1} << 20, 'x');
        const std::vector<std::string> table{
            post + "Transfer-Encoding: chunked\r\n\r\n100000\r\n" + mebi + "\r\n",
            post + "Content-Encoding: gzip\r\nContent-Length: 1048576\r\n\r\n" + mebi,
            get + "X-Long: " + mebi + "\r\n\r\n",
            get + "Range: bytes=0-,0-,0-\r\n\r\n",
            get + "Content-Length: 10\r\n\r\n0123456789",
            post + "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
            post + "Content-Length: abc\r\n\r\n",
            get + "REMOTE_ADDR: 10.0.0.1\r\n\r\n",
            post + "Content-Length: 99999999999\r\n\r\n",
        };
        for (; !stop_; ++rounds_) {
            for (const std::string& bytes : table) {
                Connection connection(port, 1);
                connection.send(bytes);
                connection.read();
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
    }

    std::atomic<bool> stop_{false};
    std::atomic<int> rounds_{0};
    std::list<std::jthread> threads_;
};

/// How long a client with manners waits, again and again for a while.
std::vector<double> waits(int port, std::chrono::milliseconds duration) {
    SteadyClient client(port, 30);
    std::vector<double> all;
    for (const auto end = Clock::now() + duration; Clock::now() < end;) {
        const auto start = Clock::now();
        const Answer answer = client.ask("GET", kHonest + "/elevation?x=4&y=4");
        all.push_back(milliseconds_since(start));
        EXPECT_EQ(answer.status, 200) << answer.body;
        if (answer.status != 200) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return all;
}

TEST_F(Edge, AClientWithMannersHardlyNoticesAnAttack) {
    const auto duration = std::chrono::milliseconds(is_long_form() ? 60'000 : 3000);
    const auto alone = waits(proxy_->port(), duration / 3);
    std::vector<double> meanwhile;
    {
        const Attackers attackers(proxy_->port());
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        meanwhile = waits(proxy_->port(), duration);
        EXPECT_GT(attackers.rounds(), 0);
    }
    const double p99 = quantile(meanwhile, 0.99);
    std::string load;
    std::getline(std::ifstream("/proc/loadavg"), load);
    std::cout << "alone p50 " << quantile(alone, 0.5) << " ms, p99 " << quantile(alone, 0.99)
              << " ms; under attack p50 " << quantile(meanwhile, 0.5) << " ms, p99 " << p99
              << " ms of " << meanwhile.size() << "; load " << load << "\n";
    EXPECT_GT(meanwhile.size(), 5U);
    EXPECT_LT(p99, most_milliseconds());
}

}  // namespace
}  // namespace tinsmith::e2e
