// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_server.hpp"

#include <atomic>
#include <list>
#include <thread>

#include <gtest/gtest.h>

#include "server/reply.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::server {
namespace {

using Client = e2e::Connection;

const std::string kGet = e2e::request_text("GET", "/");

/// A server that answers every request alike.
class ServerAtWork {
  public:
    explicit ServerAtWork(HttpOptions options, std::string body = "{}")
        : body_(std::move(body)), server_(with_free_port(options), calls()) {
        std::string error;
        port_ = server_.bind(error);
        EXPECT_EQ(error, "");
        thread_ = std::thread([this] { EXPECT_TRUE(server_.serve()); });
    }
    ~ServerAtWork() { stop(); }

    int port() const { return port_; }
    std::size_t connections() const { return server_.connections()->connections; }
    void stop() {
        server_.stop();
        if (thread_.joinable()) thread_.join();
    }

    std::atomic<int> answered{0};
    std::atomic<bool> is_held{false};  ///< no request is answered for now

  private:
    static HttpOptions with_free_port(HttpOptions options) {
        options.port = 0;
        return options;
    }

    HttpServer::Calls calls() {
        return {[](Request&) { return std::nullopt; },
                [this](const Request& request) {
                    ++answered;
                    while (is_held)
                        std::this_thread::sleep_for(std::chrono::milliseconds(1));
                    if (request.path == "/throws") throw std::bad_alloc();
                    return ok("application/json", body_);
                },
                [](const Request&, Response&) {}, [](const Request&, const Response&, double) {}};
    }

    const std::string body_;
    HttpServer server_;
    int port_ = 0;
    std::thread thread_;
};

bool becomes(const std::function<bool()>& is_so) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!is_so()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

TEST(HttpServerAlone, AnswersWhatHasArrivedWhenItStops) {
    ServerAtWork server({});
    std::list<Client> clients;
    for (int i = 0; i < 40; ++i) {
        clients.emplace_back(server.port());
        clients.back().send(kGet);
        ASSERT_EQ(clients.back().read().status, 200);
    }
    for (Client& client : clients)
        client.send(kGet);
    server.stop();
    for (Client& client : clients) {
        EXPECT_EQ(client.read().status, 200);
        EXPECT_TRUE(client.is_closed());
    }
}

TEST(HttpServerAlone, SendsAllToWhoReadsSlowly) {
    HttpOptions options;
    options.wait = std::chrono::seconds(5);
    options.patience = std::chrono::seconds(1);
    options.slowest = 100'000;
    const std::string body(6'000'000, 'x');
    ServerAtWork server(options, body);
    Client client(server.port());
    client.send(kGet);
    client.read_at_most(2'000'000);  // bytes a second
    EXPECT_EQ(client.read().body.size(), body.size());
}

/// What waits for a thread has a bound; what is beyond it is told when to come again.
TEST(HttpServerAlone, RefusesWhatItCannotHold) {
    HttpOptions options;
    options.threads = 2;
    ServerAtWork server(options);
    server.is_held = true;
    std::string head = "GET / HTTP/1.1\r\nHost: x\r\n";
    for (int i = 0; i < 7; ++i)
        head += "X-" + std::to_string(i) + ": " + std::string(7900, 'y') + "\r\n";
    std::list<Client> clients;
    for (int i = 0; i < 200; ++i) {
        clients.emplace_back(server.port(), 30).send(head + "\r\n");  // 11 MB
        // All at once would pass what heads may hold that are not whole yet.
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
    int refused = 0;
    EXPECT_EQ(clients.back().read().status, 503) << "while the others wait";
    server.is_held = false;
    clients.pop_back();
    for (Client& client : clients) {
        const e2e::Answer answer = client.read();
        if (answer.status != 503) {
            EXPECT_EQ(answer.status, 200);
            continue;
        }
        ++refused;
        EXPECT_EQ(answer.header("retry-after"), "1");
        EXPECT_EQ(answer.header("connection"), "close");
    }
    EXPECT_GT(refused, 10);
    EXPECT_LT(refused, 100);
}

TEST(HttpServerAlone, CutsWhoReadsNothing) {
    HttpOptions options;
    options.wait = std::chrono::seconds(1);
    ServerAtWork server(options, std::string(50'000'000, 'x'));
    const Client client(server.port());
    client.send(kGet);
    ASSERT_TRUE(becomes([&] { return server.answered == 1; }));
    EXPECT_TRUE(becomes([&] { return server.connections() == 0; }));
}

/// The library has its own mind about Expect, and another one in each release.
TEST(HttpServerAlone, InvitesBodiesItself) {
    ServerAtWork server({});
    const auto post = [](const std::string& version, const std::string& expected) {
        return "POST / HTTP/" + version +
               "\r\nHost: x\r\nContent-Length: 2\r\nExpect: " + expected + "\r\n\r\n";
    };
    for (const char* expected : {"100-continue", "100-Continue"}) {
        Client client(server.port());
        client.send(post("1.1", expected));
        EXPECT_EQ(client.read().status, 100) << expected;
        client.send("{}");
        EXPECT_EQ(client.read().status, 200) << expected;
        Client older(server.port());
        older.send(post("1.0", expected) + "{}");
        EXPECT_EQ(older.read().status, 200) << expected << ", and nothing before";
        EXPECT_TRUE(older.is_closed());
    }
    Client client(server.port());
    client.send(post("1.1", "eggs"));
    EXPECT_EQ(client.read().status, 417);
    EXPECT_TRUE(client.is_closed());
}

TEST(HttpServerAlone, GoesOnAfterARequestWithoutMemory) {
    ServerAtWork server({});
    for (int i = 0; i < 100; ++i) {
        Client client(server.port());
        client.send(e2e::request_text("GET", "/throws"));
        EXPECT_EQ(client.read().status, 500);
    }
    Client client(server.port());
    client.send(kGet);
    EXPECT_EQ(client.read().status, 200);
}

/// More clients than there may be connections, some of which only sit there: each is answered or
/// sent away, and then it comes again.
TEST(HttpServerAlone, ServesACrowdOverFewConnections) {
    HttpOptions options;
    options.threads = 4;
    options.max_connections = 6;
    ServerAtWork server(options);
    std::atomic<int> answered{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 8; ++t) {
        threads.emplace_back([&, t] {
            for (int done = 0; done < 50;) {
                Client client(server.port());
                if (t % 4 == 0) client.send("GET / HT");
                for (int i = 0; i < 5 && done < 50; ++i) {
                    client.send(t % 4 == 0 && i == 0 ? kGet.substr(8) : kGet);
                    if (client.read().status != 200) break;
                    ++done;
                    ++answered;
                }
            }
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(answered, 8 * 50);
}

TEST(HttpServerAlone, MayStopBeforeItServes) {
    HttpOptions options;
    options.port = 0;
    HttpServer server(options, {});
    server.stop();
    std::string error;
    ASSERT_NE(server.bind(error), 0) << error;
    server.stop();
    EXPECT_TRUE(server.serve());
}

}  // namespace
}  // namespace tinsmith::server
