// SPDX-License-Identifier: Apache-2.0
#include "server/http/reception.hpp"

#include <list>

#include <gtest/gtest.h>

#include "server/http/request_head.hpp"
#include "tests/unit/server/http/reception_at_work.hpp"

namespace tinsmith::server {
namespace {

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

/// Whose request has come, but had no turn yet, is not sent away as one that says nothing.
TEST(Reception, KeepsThoseWhoseRequestIsThereAlready) {
    for (const bool is_kept : {true, false}) {
        ReceptionOptions options;
        options.max_connections = 3;
        ReceptionAtWork reception(options);
        const Client asks(reception.port());  // has waited longest
        if (is_kept) {
            asks.send(kGet);
            Arrival arrival = reception.next();
            ASSERT_TRUE(arrival.connection);
            arrival.connection->use(kGet.size());
            EXPECT_FALSE((*reception).keep(std::move(arrival.connection)));
        }
        Client silent(reception.port());
        const Client holds(reception.port());
        ASSERT_TRUE(becomes([&] { return reception.totals.connections == 3; }));
        reception.hold();
        holds.send(kGet);
        Arrival held = reception.next();
        ASSERT_TRUE(held.connection);
        const Client comes(reception.port());  // so the listener has its turn first
        comes.send(kGet);
        asks.send(kGet);
        reception.let_go();
        for (int i = 0; i < 2; ++i)
            EXPECT_TRUE(reception.next().connection) << is_kept << i;
        EXPECT_TRUE(silent.is_closed());
        EXPECT_EQ(reception.totals.sent_away, 1U);
    }
}

/// There has to be room for the one that comes, whatever the others have sent.
TEST(Reception, SendsOneAwayWhereAllHaveAsked) {
    ReceptionOptions options;
    options.max_connections = 3;
    ReceptionAtWork reception(options);
    std::list<Client> clients;
    for (int i = 0; i < 3; ++i)
        clients.emplace_back(reception.port());
    ASSERT_TRUE(becomes([&] { return reception.totals.connections == 3; }));
    reception.hold();
    clients.back().send(kGet);
    const Arrival held = reception.next();
    ASSERT_TRUE(held.connection);
    const Client comes(reception.port());
    comes.send(kGet);
    for (Client& client : clients)
        client.send(kGet);
    reception.let_go();
    for (int i = 0; i < 2; ++i)
        EXPECT_TRUE(reception.next().connection) << i;
    EXPECT_TRUE(clients.front().is_closed());
    EXPECT_LE(reception.totals.connections, 3U);
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
