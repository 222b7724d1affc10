// SPDX-License-Identifier: Apache-2.0
// Every place at which the way of a request from its socket to its answer asks for memory is
// refused once: that costs the request at most, and its connection.
#include <atomic>
#include <chrono>
#include <iostream>
#include <thread>

#include <gtest/gtest.h>

#include "server/http/http_server.hpp"
#include "server/http/listener.hpp"
#include "server/http/reception.hpp"
#include "server/reply.hpp"
#include "tests/e2e/wire.hpp"
#include "tests/memory/failing_new.hpp"

namespace tinsmith::server {
namespace {

using e2e::Answer;
using memory::Shortage;
using Client = e2e::Connection;

/// More than any request asks for memory.
constexpr long kMostTimes = 5000;
/// What is refused at a time: once, or for a while.
constexpr long kOnce = 1;
constexpr long kForAWhile = 8;

const std::string kBody(10'000, 'x');

/// A server that answers what it was sent.
class EchoingServer {
  public:
    EchoingServer() : server_(options(), calls()) {
        std::string error;
        port_ = server_.bind(error);
        EXPECT_EQ(error, "");
        thread_ = std::thread([this] { is_fine_ = server_.serve(); });
        EXPECT_EQ(e2e::ask(port_, "GET", "/").status, 200) << "its threads are there";
    }
    ~EchoingServer() { stop(); }

    int port() const { return port_; }
    std::size_t connections() const { return server_.connections()->connections; }
    /// Whether it served until it was told to stop.
    bool stop() {
        server_.stop();
        if (thread_.joinable()) thread_.join();
        return is_fine_;
    }

  private:
    static HttpOptions options() {
        HttpOptions options;
        options.port = 0;
        options.threads = 2;
        return options;
    }
    static HttpServer::Calls calls() {
        return {[](Request&) { return std::nullopt; },
                [](const Request& request) { return ok("text/plain", "got " + request.body); },
                [](const Request&, Response&) {}, [](const Request&, const Response&, double) {}};
    }

    HttpServer server_;
    int port_ = 0;
    std::atomic<bool> is_fine_{false};
    std::thread thread_;
};

/// Sends the request once for each time that it asks for memory. What became of it is one of
/// `allowed` or nothing, and the next one is answered as ever. Returns how often there was a
/// shortage.
long send_through_shortages(EchoingServer& server, const std::string& request,
                            const std::string& answer, long count) {
    long first = 0;
    for (bool was_felt = true; was_felt && first < kMostTimes; ++first) {
        {
            Client client(server.port(), 30);
            const Shortage shortage(first, count);
            client.send(request);
            const int status = client.read().status;
            was_felt = shortage.was_felt();
            EXPECT_TRUE(status == 200 || (was_felt && (status == 0 || status == 500))) << status;
        }
        Client client(server.port(), 30);
        client.send(request);
        const Answer after = client.read();
        EXPECT_EQ(after.status, 200) << "after shortage " << first;
        EXPECT_EQ(after.body, answer);
        if (testing::Test::HasFailure()) break;
    }
    std::cout << first << " times asked for memory\n";
    return first;
}

TEST(WantOfMemory, CostsOneRequestAtMost) {
    EchoingServer server;
    const std::string get = e2e::request_text("GET", "/a?b=c", {"X-A: " + kBody.substr(0, 500)});
    const std::string put = e2e::request_text("PUT", "/", {"Connection: close"}, kBody);
    for (const long count : {kOnce, kForAWhile}) {
        EXPECT_GT(send_through_shortages(server, get, "got ", count), 10);
        EXPECT_GT(send_through_shortages(server, put, "got " + kBody, count), 10);
    }
    for (int i = 0; i < 1000 && server.connections() > 0; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_EQ(server.connections(), 0U);
    EXPECT_TRUE(server.stop());
}

/// It hands over, or closes.
TEST(WantOfMemory, DoesNotEndTheReception) {
    ConnectionTotals totals;
    std::atomic<int> handed_over{0};
    const Listener listener = listen_on("127.0.0.1", 0);
    Reception reception(listener.socket, {}, totals, [&](Arrival arrival) {
        EXPECT_EQ(arrival.state, Arrival::State::Whole);
        ++handed_over;
    });
    std::atomic<bool> is_fine{false};
    std::thread thread([&] { is_fine = reception.run(); });
    const std::string request = e2e::request_text("GET", "/" + std::string(5000, 'a'));
    long first = 0;
    for (bool was_felt = true; was_felt && first < kMostTimes && !HasFailure(); ++first) {
        {
            Client client(listener.port);
            const Shortage shortage(first);
            client.send(request);
            EXPECT_TRUE(client.is_closed()) << first;
            was_felt = shortage.was_felt();
        }
        const int before = handed_over;
        Client client(listener.port);
        client.send(request.substr(0, 3000));
        client.send(request.substr(3000));
        EXPECT_TRUE(client.is_closed()) << first;
        EXPECT_EQ(handed_over, before + 1) << first;
    }
    // For what was sent once at least; a connection may have been taken before the shortage.
    EXPECT_GE(first, 2);
    reception.stop();
    thread.join();
    EXPECT_TRUE(is_fine);
    EXPECT_EQ(totals.connections, 0U);
}

}  // namespace
}  // namespace tinsmith::server
