// SPDX-License-Identifier: Apache-2.0
#include "server/http/reception.hpp"

#include <condition_variable>
#include <deque>
#include <thread>

#include <gtest/gtest.h>

#include "server/http/listener.hpp"
#include "server/http/request_head.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::server {
namespace {

using std::chrono::milliseconds;
using Client = e2e::Connection;

const std::string kGet = "GET / HTTP/1.1\r\nHost: x\r\n\r\n";

/// A reception and what has arrived at it.
class ReceptionAtWork {
  public:
    explicit ReceptionAtWork(ReceptionOptions options = {})
        : listener_(listen_on("127.0.0.1", 0)),
          reception_(listener_.socket, options, totals,
                     [this](Arrival arrival) { take(std::move(arrival)); }),
          thread_([this] { EXPECT_TRUE(reception_.run()); }) {}
    ~ReceptionAtWork() { stop(); }

    ConnectionTotals totals;

    int port() const { return listener_.port; }
    Reception& operator*() { return reception_; }

    void stop() {
        reception_.stop();
        if (thread_.joinable()) thread_.join();
    }

    /// The next, or one without a connection where none comes for so long.
    Arrival next(milliseconds longest = milliseconds(10'000)) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, longest, [this] { return !arrived_.empty(); });
        if (arrived_.empty()) return {};
        Arrival arrival = std::move(arrived_.front());
        arrived_.pop_front();
        return arrival;
    }

  private:
    void take(Arrival arrival) {
        {
            const std::lock_guard lock(mutex_);
            arrived_.push_back(std::move(arrival));
        }
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Arrival> arrived_;
    Listener listener_;
    Reception reception_;
    std::thread thread_;
};

bool becomes(const std::function<bool()>& is_so) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!is_so()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::yield();
    }
    return true;
}

ReceptionOptions with_waits(int head, int idle) {
    ReceptionOptions options;
    options.head = milliseconds(head);
    options.idle = milliseconds(idle);
    return options;
}

TEST(Reception, HandsOverHeadsThatAreWhole) {
    ReceptionAtWork reception;
    const Client client(reception.port());
    client.send(kGet.substr(0, 10));
    EXPECT_FALSE(reception.next(milliseconds(50)).connection);
    client.send(kGet.substr(10) + "more");
    const Arrival arrival = reception.next();
    ASSERT_TRUE(arrival.connection);
    EXPECT_EQ(arrival.state, Arrival::State::Whole);
    EXPECT_EQ(arrival.connection->unread(), kGet + "more");
    EXPECT_EQ(arrival.connection->size_of_head(), kGet.size());
    EXPECT_EQ(arrival.connection->size_of_head(), kGet.size()) << "as often as it is asked";
    EXPECT_EQ(arrival.connection->remote().first, "127.0.0.1");
    EXPECT_EQ(arrival.connection->local().second, reception.port());
}

TEST(Reception, KeepsConnectionsForTheirNextRequest) {
    ReceptionAtWork reception;
    const Client client(reception.port());
    for (int i = 0; i < 5; ++i) {
        client.send("\r\n" + kGet);
        Arrival arrival = reception.next();
        ASSERT_TRUE(arrival.connection) << i;
        EXPECT_EQ(arrival.connection->unread(), kGet);
        arrival.connection->use(kGet.size());
        EXPECT_FALSE((*reception).keep(std::move(arrival.connection)));
    }
}

TEST(Reception, CutsHeadsThatTakeTooLong) {
    ReceptionAtWork reception(with_waits(1000, 60'000));
    const Client drips(reception.port());
    drips.send("GET / HTTP/1.1\r\n");
    Arrival arrival;
    for (int i = 0; i < 1000 && !arrival.connection; ++i) {
        drips.send("X: y\r\n");
        arrival = reception.next(milliseconds(20));
    }
    ASSERT_TRUE(arrival.connection);
    EXPECT_EQ(arrival.state, Arrival::State::Late);
}

TEST(Reception, ClosesWhoSaysNothing) {
    ReceptionAtWork for_the_silent(with_waits(50, 60'000));
    Client silent(for_the_silent.port());
    EXPECT_TRUE(silent.is_closed());
    ReceptionAtWork reception(with_waits(60'000, 50));
    Client idle(reception.port());
    idle.send(kGet);
    Arrival arrival = reception.next();
    ASSERT_TRUE(arrival.connection);
    arrival.connection->use(kGet.size());
    EXPECT_FALSE((*reception).keep(std::move(arrival.connection)));
    EXPECT_TRUE(idle.is_closed());
}

TEST(Reception, BoundsAHead) {
    ReceptionAtWork reception;
    const Client client(reception.port());
    client.send(kGet.substr(0, kGet.size() - 2) + "X: " + std::string(kMaxHeadBytes, 'a'));
    const Arrival arrival = reception.next();
    ASSERT_TRUE(arrival.connection);
    EXPECT_EQ(arrival.state, Arrival::State::TooLarge);
    EXPECT_LT(arrival.connection->unread().size(), 2 * kMaxHeadBytes);
}

TEST(Reception, BoundsAllHeadsTogether) {
    ReceptionOptions options;
    options.max_head_bytes = 100'000;
    ReceptionAtWork reception(options);
    std::list<Client> clients;
    for (int i = 0; i < 8; ++i)
        clients.emplace_back(reception.port()).send("GET /" + std::string(30'000, 'a'));
    EXPECT_TRUE(clients.front().is_closed()) << "who has waited longest goes";
    const Client honest(reception.port());
    honest.send(kGet);
    EXPECT_TRUE(reception.next().connection);
    EXPECT_GT(reception.totals.sent_away, 0U);
    EXPECT_LT(reception.totals.sent_away, 8U);
}

TEST(Reception, LetsInWhoAsksHoweverManySitThere) {
    ReceptionOptions options;
    options.max_connections = 10;
    ReceptionAtWork reception(options);
    std::list<Client> idle;
    for (int i = 0; i < 10; ++i)
        idle.emplace_back(reception.port());
    ASSERT_TRUE(becomes([&] { return reception.totals.connections == 10; }));
    for (int i = 0; i < 20; ++i)
        idle.emplace_back(reception.port());
    const Client honest(reception.port());
    honest.send(kGet);
    const Arrival arrival = reception.next();
    ASSERT_TRUE(arrival.connection);
    EXPECT_EQ(arrival.connection->unread(), kGet);
    EXPECT_LE(reception.totals.connections, 10U);
    EXPECT_TRUE(idle.front().is_closed());
    EXPECT_EQ(reception.totals.sent_away, 21U);
}

TEST(Reception, LetsInWhoAsksWhereOthersKeepTheirConnections) {
    ReceptionOptions options;
    options.max_connections = 5;
    ReceptionAtWork reception(options);
    std::list<Client> kept;
    for (int i = 0; i < 5; ++i) {
        kept.emplace_back(reception.port()).send(kGet);
        Arrival arrival = reception.next();
        ASSERT_TRUE(arrival.connection);
        arrival.connection->use(kGet.size());
        EXPECT_FALSE((*reception).keep(std::move(arrival.connection)));
    }
    const Client honest(reception.port());
    honest.send(kGet);
    EXPECT_TRUE(reception.next().connection);
    EXPECT_TRUE(kept.front().is_closed()) << "the one that has idled longest";
}

TEST(Reception, TakesAnEmptyLineForNoRequest) {
    ReceptionAtWork reception(with_waits(60'000, 100));
    Client client(reception.port());
    client.send(kGet + "\r\n");
    Arrival arrival = reception.next();
    ASSERT_TRUE(arrival.connection);
    arrival.connection->use(kGet.size());
    EXPECT_EQ(arrival.connection->size_of_head(), 0U);
    EXPECT_FALSE((*reception).keep(std::move(arrival.connection)));
    client.send("\r\n");
    EXPECT_TRUE(client.is_closed()) << "as one that idles, without a word";
    EXPECT_FALSE(reception.next(milliseconds(1)).connection);
}

TEST(Reception, HandsOverWhatHasComeByItsEnd) {
    ReceptionAtWork reception;
    std::list<Client> clients;
    for (int i = 0; i < 200; ++i)
        clients.emplace_back(reception.port()).send(kGet);
    reception.stop();
    for (int i = 0; i < 200; ++i)
        EXPECT_TRUE(reception.next(milliseconds(0)).connection) << i;
}

TEST(Reception, LetsNobodyInWhereAllAreServed) {
    ReceptionOptions options;
    options.max_connections = 2;
    ReceptionAtWork reception(options);
    const Client one(reception.port());
    one.send(kGet);
    Arrival first = reception.next();
    const Client two(reception.port());
    two.send(kGet);
    const Arrival second = reception.next();
    ASSERT_TRUE(first.connection && second.connection);
    const Client three(reception.port());
    three.send(kGet);
    EXPECT_FALSE(reception.next(milliseconds(100)).connection) << "there is no place for it yet";
    first.connection.reset();
    EXPECT_TRUE(reception.next().connection);
}

TEST(Reception, PartsWithoutLosingTheAnswer) {
    ReceptionAtWork reception;
    Client client(reception.port());
    client.send(kGet + std::string(1'000'000, 'x'));
    Arrival arrival = reception.next();
    ASSERT_TRUE(arrival.connection);
    const std::string answer = "HTTP/1.1 400 Bad\r\nContent-Length: 2\r\n\r\nno";
    ASSERT_EQ(arrival.connection->write(answer, {}, milliseconds(1000)),
              static_cast<long>(answer.size()));
    (*reception).part(std::move(arrival.connection));
    EXPECT_EQ(client.read().body, "no");
    EXPECT_TRUE(client.is_closed());
}

TEST(Reception, ClosesAllAtItsEnd) {
    ReceptionAtWork reception;
    Client waits(reception.port()), served(reception.port());
    served.send(kGet);
    Arrival arrival = reception.next();
    ASSERT_TRUE(arrival.connection);
    reception.stop();
    EXPECT_TRUE(waits.is_closed());
    arrival.connection = (*reception).keep(std::move(arrival.connection));
    EXPECT_TRUE(arrival.connection) << "it comes back";
    arrival.connection.reset();
    EXPECT_TRUE(served.is_closed());
    EXPECT_EQ(reception.totals.connections, 0U);
}

}  // namespace
}  // namespace tinsmith::server
