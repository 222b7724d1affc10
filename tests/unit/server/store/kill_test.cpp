// SPDX-License-Identifier: Apache-2.0
// The process ends in the middle of its work, and another one goes on.
#include <array>
#include <csignal>
#include <cstdint>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/unit/server/store/journal_folder.hpp"

namespace tinsmith::server {
namespace {

constexpr std::size_t kThreads = 4;

/// What was acknowledged, told through a pipe, which outlives the teller.
struct Told {
    std::uint64_t session;
    std::uint64_t version;
};

class Kill : public JournalFolder {
  protected:
    static std::string birth(std::size_t i) { return "birth " + std::to_string(i); }

    /// In a process of its own; ends by the signal alone.
    [[noreturn]] void work(int pipe, const std::array<std::uint64_t, kThreads>& newest) const {
        const auto opened = Journal::open(options_);
        if (opened.index() != 0) ::_exit(1);
        Journal& journal = *std::get<0>(opened);
        std::vector<std::thread> threads;
        for (std::size_t i = 0; i < kThreads; ++i) {
            threads.emplace_back([this, &journal, pipe, i, version = newest[i]]() mutable {
                for (;;) {
                    if (journal.append(entry(birth(i), ++version))) ::_exit(2);
                    const Told told{i, version};
                    if (::write(pipe, &told, sizeof told) != sizeof told) ::_exit(3);
                    if (version % 40 == 0 &&
                        journal.write_snapshot(birth(i), head(version), mesh(version)))
                        ::_exit(4);
                }
            });
        }
        for (;;)
            ::pause();
    }

    static std::string mesh(std::uint64_t version) {
        return std::string(20'000, static_cast<char>('a' + version % 26));
    }
};

TEST_F(Kill, LosesNothingThatWasAcknowledged) {
    options_.part_bytes = 4096;
    options_.log_pages = 100;
    std::array<std::uint64_t, kThreads> newest{};
    {
        auto journal = open();
        for (std::size_t i = 0; i < kThreads; ++i)
            make(*journal, birth(i), birth(i), 0, mesh(0));
    }
    std::mt19937_64 random(7);
    std::uint64_t acknowledged = 0;
    for (int round = 0; round < 20; ++round) {
        std::array<int, 2> ends{};
        ASSERT_EQ(::pipe(ends.data()), 0);
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) work(ends[1], newest);
        ::close(ends[1]);
        std::array<std::uint64_t, kThreads> told = newest;
        // After some acknowledgements, and a moment more.
        const std::uint64_t wanted = 1 + random() % 60;
        Told one{};
        std::uint64_t count = 0;
        for (; ::read(ends[0], &one, sizeof one) == sizeof one;
             told.at(one.session) = one.version) {
            if (++count != wanted) continue;
            ::usleep(static_cast<useconds_t>(random() % 3000));
            ::kill(child, SIGKILL);
        }
        ::close(ends[0]);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        ASSERT_TRUE(WIFSIGNALED(status)) << "it ended by itself: " << WEXITSTATUS(status);
        acknowledged += count;

        auto journal = open();
        ASSERT_TRUE(journal);
        for (std::size_t i = 0; i < kThreads; ++i) {
            const StoredSession stored = read(*journal, birth(i));
            EXPECT_EQ(stored.bytes, mesh(stored.head.version));
            std::uint64_t version = stored.head.version;
            for (const JournalEntry& each : stored.tail)
                EXPECT_EQ(each, entry(birth(i), ++version));
            EXPECT_GE(version, told[i]);
            EXPECT_LE(version, told[i] + 1) << "one can be under way";
            newest[i] = version;
        }
    }
    EXPECT_GT(acknowledged, 200U);
}

}  // namespace
}  // namespace tinsmith::server
