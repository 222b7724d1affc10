// SPDX-License-Identifier: Apache-2.0
#include "server/http/descriptors.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tinsmith::server {
namespace {

/// What a process is allowed whose limits are these, of 200 connections; and to which number of
/// descriptors that has brought it.
struct Allowed {
    std::size_t connections = 0;
    rlim_t descriptors = 0;
};

Allowed allowed(rlim_t soft, rlim_t hard) {
    int ends[2] = {-1, -1};
    EXPECT_EQ(::pipe(ends), 0);
    // A process of its own: nobody can raise the hard limit again.
    const pid_t child = ::fork();
    if (child == 0) {
        const rlimit limit{soft, hard};
        Allowed result;
        rlimit now{};
        if (::setrlimit(RLIMIT_NOFILE, &limit) == 0) result.connections = allow_connections(200);
        ::getrlimit(RLIMIT_NOFILE, &now);
        result.descriptors = now.rlim_cur;
        ::_exit(::write(ends[1], &result, sizeof result) == sizeof result ? 0 : 1);
    }
    Allowed result;
    EXPECT_EQ(::read(ends[0], &result, sizeof result), static_cast<ssize_t>(sizeof result));
    ::close(ends[0]);
    ::close(ends[1]);
    ::waitpid(child, nullptr, 0);
    return result;
}

TEST(Descriptors, AreAllowedAsFarAsTheSystemGoes) {
    const Allowed enough = allowed(1000, 1000);
    EXPECT_EQ(enough.connections, 200U);
    EXPECT_EQ(enough.descriptors, 1000U) << "nothing to be done";
    const Allowed raised = allowed(64, 1000);
    EXPECT_EQ(raised.connections, 200U);
    EXPECT_EQ(raised.descriptors, 456U) << "with some for others";
    const Allowed fewer = allowed(64, 300);
    EXPECT_EQ(fewer.connections, 44U);
    EXPECT_EQ(fewer.descriptors, 300U);
    EXPECT_EQ(allowed(100, 100).connections, 50U) << "half of a few";
}

}  // namespace
}  // namespace tinsmith::server
