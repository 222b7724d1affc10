// SPDX-License-Identifier: Apache-2.0
// A reception in a process that may open no more.
#include <ctime>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "tests/unit/server/http/reception_at_work.hpp"

namespace tinsmith::server {
namespace {

/// Leaves this process so many descriptors, and those that it has.
class DescriptorsLeft {
  public:
    explicit DescriptorsLeft(int count) {
        ::getrlimit(RLIMIT_NOFILE, &before_);
        std::vector<int> taken;
        while (count-- > 0)
            taken.push_back(::dup(STDERR_FILENO));
        rlimit few = before_;
        few.rlim_cur = taken.empty() ? 0 : static_cast<rlim_t>(taken.back()) + 1;
        EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
        for (const int each : taken)
            ::close(each);
    }
    ~DescriptorsLeft() { ::setrlimit(RLIMIT_NOFILE, &before_); }
    DescriptorsLeft(const DescriptorsLeft&) = delete;
    DescriptorsLeft& operator=(const DescriptorsLeft&) = delete;

  private:
    rlimit before_{};
};

/// EMFILE: who has waited longest gives its place.
TEST(FewDescriptors, LetsInWhoAsksWhereNoDescriptorIsLeft) {
    ReceptionAtWork reception;
    Client idle(reception.port()), other(reception.port());
    ASSERT_TRUE(becomes([&] { return reception.totals.connections == 2; }));
    const DescriptorsLeft few(1);  // the client's
    const Client honest(reception.port());
    honest.send(kGet);
    EXPECT_TRUE(reception.next().connection);
    EXPECT_TRUE(idle.is_closed());
    EXPECT_EQ(reception.totals.sent_away, 1U);
}

/// EMFILE where nobody waits: it tries again, without spinning, until one is free.
TEST(FewDescriptors, WaitsForADescriptorWhereNobodyCanGo) {
    ReceptionAtWork reception;
    const Client served(reception.port());
    served.send(kGet);
    Arrival first = reception.next();
    ASSERT_TRUE(first.connection);
    const DescriptorsLeft few(1);
    const Client waits(reception.port());
    waits.send(kGet);
    timespec before{}, after{};
    clockid_t clock{};
    EXPECT_FALSE(reception.next(milliseconds(500)).connection);
    ASSERT_EQ(reception.clock(clock), 0);
    ::clock_gettime(clock, &before);
    EXPECT_FALSE(reception.next(milliseconds(500)).connection);
    ::clock_gettime(clock, &after);
    const double spent = static_cast<double>(after.tv_sec - before.tv_sec) +
                         static_cast<double>(after.tv_nsec - before.tv_nsec) / 1e9;
    EXPECT_LT(spent, 0.25) << "seconds of the processor, in half a second";
    first.connection.reset();
    EXPECT_TRUE(reception.next().connection);
    EXPECT_EQ(reception.totals.sent_away, 0U);
}

}  // namespace
}  // namespace tinsmith::server
