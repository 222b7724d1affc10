// SPDX-License-Identifier: Apache-2.0
#include "server/http/crew.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <new>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tinsmith::server {
namespace {

/// What has arrived, with its number in front of so many bytes. The sockets' other ends are here.
class Arrivals {
  public:
    ~Arrivals() {
        for (const int socket : others_)
            ::close(socket);
    }

    Arrival make(int number, std::size_t bytes = 10) {
        int sockets[2] = {-1, -1};
        EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets), 0);
        others_.push_back(sockets[0]);
        Arrival arrival{std::make_unique<Connection>(sockets[1], totals_), Arrival::State::Whole};
        std::string text = std::to_string(number);
        text.resize(bytes, ' ');
        for (std::string_view rest = text; !rest.empty();) {
            const ssize_t sent = ::send(sockets[0], rest.data(), std::min(rest.size(), kPiece),
                                        MSG_DONTWAIT | MSG_NOSIGNAL);
            if (sent > 0) rest.remove_prefix(static_cast<std::size_t>(sent));
            if (arrival.connection->receive(bytes) == Connection::Got::End) break;
        }
        arrival.connection->receive(bytes);
        EXPECT_EQ(arrival.connection->unread().size(), bytes);
        return arrival;
    }

    static int number_of(const Arrival& arrival) {
        return std::stoi(std::string(arrival.connection->unread()));
    }

    std::size_t open() const { return totals_.connections; }

  private:
    static constexpr std::size_t kPiece = 4096;

    ConnectionTotals totals_;
    std::vector<int> others_;
};

/// Waits until somebody opens it.
class Barrier {
  public:
    ~Barrier() { open(); }
    void open() { is_open_ = true; }
    void wait() const {
        while (!is_open_)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

  private:
    std::atomic<bool> is_open_{false};
};

bool becomes(const std::function<bool()>& is_so) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!is_so()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

TEST(Crew, ServesAllOfThem) {
    Arrivals arrivals;
    std::mutex mutex;
    std::set<int> served;
    std::set<std::thread::id> threads;
    {
        Crew crew(4, [&](Arrival arrival) {
            const std::lock_guard lock(mutex);
            EXPECT_TRUE(served.insert(Arrivals::number_of(arrival)).second);
            threads.insert(std::this_thread::get_id());
        });
        for (int i = 0; i < 300; ++i) {
            Arrival arrival = arrivals.make(i);
            EXPECT_TRUE(crew.add(arrival));
            EXPECT_FALSE(arrival.connection);
        }
    }
    EXPECT_EQ(served.size(), 300U);
    EXPECT_LE(threads.size(), 4U);
    EXPECT_FALSE(threads.contains(std::this_thread::get_id()));
    EXPECT_EQ(arrivals.open(), 0U) << "a connection ends with who serves it";
}

TEST(Crew, ServesInTheOrderInWhichTheyCame) {
    Arrivals arrivals;
    Barrier barrier;
    std::vector<int> served;
    Crew crew(1, [&](Arrival arrival) {
        barrier.wait();
        served.push_back(Arrivals::number_of(arrival));
    });
    for (int i = 0; i < 50; ++i) {
        Arrival arrival = arrivals.make(i);
        EXPECT_TRUE(crew.add(arrival));
    }
    barrier.open();
    crew.finish();
    ASSERT_EQ(served.size(), 50U);
    EXPECT_TRUE(std::is_sorted(served.begin(), served.end()));
}

TEST(Crew, OutlivesWhatIsThrown) {
    Arrivals arrivals;
    std::atomic<int> served{0};
    Crew crew(2, [&](const Arrival& arrival) {
        const int number = Arrivals::number_of(arrival);
        if (number % 3 == 0) throw std::bad_alloc();
        if (number % 3 == 1) throw std::runtime_error("of a test");
        ++served;
    });
    for (int i = 0; i < 30; ++i) {
        Arrival arrival = arrivals.make(i);
        EXPECT_TRUE(crew.add(arrival));
    }
    EXPECT_TRUE(becomes([&] { return served == 10 && arrivals.open() == 0; }));
    EXPECT_TRUE(becomes([&] { return crew.has_spare(); })) << "nobody is busy for ever";
}

TEST(Crew, ServesTheRestWhenItFinishesAndNoMore) {
    Arrivals arrivals;
    Barrier barrier;
    std::atomic<int> served{0};
    Crew crew(2, [&](const Arrival&) {
        barrier.wait();
        ++served;
    });
    for (int i = 0; i < 20; ++i) {
        Arrival arrival = arrivals.make(i);
        EXPECT_TRUE(crew.add(arrival));
    }
    std::thread finishes([&] { crew.finish(); });
    Arrival late = arrivals.make(99);
    EXPECT_TRUE(becomes([&] { return !crew.add(late) || !(late = arrivals.make(99)).connection; }));
    EXPECT_TRUE(late.connection) << "it is as it was";
    EXPECT_EQ(served, 0);
    barrier.open();
    finishes.join();
    EXPECT_GE(served, 20);
    const int all = served;
    EXPECT_FALSE(crew.add(late));
    crew.finish();
    EXPECT_EQ(served, all);
}

TEST(Crew, BoundsWhatWaits) {
    constexpr std::size_t kMebi = std::size_t{1} << 20;
    Arrivals arrivals;
    Barrier barrier;
    std::atomic<int> begun{0}, served{0};
    Crew crew(1, [&](const Arrival&) {
        ++begun;
        barrier.wait();
        ++served;
    });
    Arrival first = arrivals.make(0, kMebi);
    EXPECT_TRUE(crew.add(first));
    ASSERT_TRUE(becomes([&] { return begun == 1; }));
    EXPECT_FALSE(crew.is_behind());
    for (int i = 1; i <= 8; ++i) {
        Arrival arrival = arrivals.make(i, kMebi);
        EXPECT_TRUE(crew.add(arrival)) << i << ": what is served does not count";
    }
    EXPECT_TRUE(crew.is_behind());
    EXPECT_FALSE(crew.has_spare());
    Arrival more = arrivals.make(9);
    EXPECT_FALSE(crew.add(more));
    EXPECT_EQ(Arrivals::number_of(more), 9) << "it is as it was";
    barrier.open();
    EXPECT_TRUE(becomes([&] { return served == 9; }));
    EXPECT_TRUE(crew.add(more)) << "there is room again";
    crew.finish();
    EXPECT_EQ(served, 10);
}

}  // namespace
}  // namespace tinsmith::server
