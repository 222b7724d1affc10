// SPDX-License-Identifier: Apache-2.0
// What the journal does where the disk is full or does not answer.
#include "tests/store/failing_disk.hpp"

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/server/store/journal_folder.hpp"

namespace tinsmith::server {
namespace {

using store_tests::FailingDisk;
using Kind = JournalFault::Kind;
using Work = FailingDisk::Work;
using Fault = FailingDisk::Fault;

constexpr std::uint64_t kForEver = ~std::uint64_t{0};

class DiskFaults : public JournalFolder {
  protected:
    void SetUp() override {
        JournalFolder::SetUp();
        options_.vfs = disk_.name();
        options_.probe_every = std::chrono::milliseconds(20);
        options_.part_bytes = 4096;
    }

    template <typename Condition>
    static bool comes_true(const Condition& condition) {
        for (int i = 0; i < 1000; ++i) {
            if (condition()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return false;
    }

    static void expect_entries(const Journal& journal, const std::string& birth,
                               std::uint64_t newest) {
        const StoredSession stored = read(journal, birth);
        std::uint64_t version = stored.head.version;
        for (const JournalEntry& one : stored.tail)
            EXPECT_EQ(one, entry(birth, ++version));
        EXPECT_EQ(version, newest);
    }

    FailingDisk disk_{"disk-faults"};
};

TEST_F(DiskFaults, AreToldAndGetBetter) {
    auto journal = open();
    make(*journal, "birth", "id", 0);
    std::uint64_t version = 0;
    for (const Work work : {Work::Write, Work::Sync}) {
        for (const Fault fault : {Fault::Full, Fault::Io}) {
            disk_.fail(work, fault, 0, kForEver);
            const auto since = std::chrono::system_clock::now();
            const Committed refused = journal->append(entry("birth", version + 1));
            ASSERT_TRUE(refused);
            EXPECT_EQ(refused->kind, fault == Fault::Full ? Kind::DiskFull : Kind::Io);
            EXPECT_NE(refused->text.find(file().string()), std::string::npos) << refused->text;
            const JournalHealth health = journal->health();
            EXPECT_FALSE(health.fine);
            EXPECT_EQ(health.why, refused->text);
            EXPECT_GE(health.since, since);
            // What is there can be read all the same, and the disk is asked again and again.
            expect_entries(*journal, "birth", version);
            const std::uint64_t before = journal->figures().failures;
            ASSERT_TRUE(comes_true([&] { return journal->figures().failures > before + 2; }));
            EXPECT_EQ(journal->health().since, health.since) << "since the first time";
            disk_.mend();
            ASSERT_TRUE(comes_true([&] { return journal->health().fine; }));
            ASSERT_FALSE(journal->append(entry("birth", ++version)));
            expect_entries(*journal, "birth", version);
        }
    }
    journal = reopen(std::move(journal));
    expect_entries(*journal, "birth", version);
}

TEST_F(DiskFaults, AreToldToAllWhoWaitAndChangeNothing) {
    constexpr std::size_t kThreads = 8;
    auto journal = open();
    const auto birth = [](std::size_t i) { return "b" + std::to_string(i); };
    for (std::size_t i = 0; i < kThreads; ++i)
        make(*journal, birth(i), birth(i), 0);
    std::vector<std::uint64_t> newest(kThreads);
    std::atomic<std::uint64_t> refusals{0};
    std::atomic<bool> is_done{false};
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < kThreads; ++i) {
        threads.emplace_back([&, i] {
            while (!is_done) {
                // As a session does: the version is made again where it was refused.
                if (!journal->append(entry(birth(i), newest[i] + 1))) {
                    ++newest[i];
                } else {
                    ++refusals;
                }
            }
        });
    }
    std::mt19937_64 random(1);
    for (int i = 0; i < 60; ++i) {
        disk_.fail(random() % 2 == 0 ? Work::Write : Work::Sync,
                   random() % 2 == 0 ? Fault::Full : Fault::Io, random() % 20, 1 + random() % 4);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    disk_.mend();
    is_done = true;
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_GT(refusals, 20U);
    ASSERT_TRUE(comes_true([&] { return journal->health().fine; }));
    for (int i = 0; i < 2; ++i) {
        for (std::size_t k = 0; k < kThreads; ++k)
            expect_entries(*journal, birth(k), newest[k]);
        journal = reopen(std::move(journal));
    }
}

/// The sync that fails leaves a whole commit in the log, as far as reading shows.
TEST_F(DiskFaults, ACommitWhoseSyncFailedIsNoneForGood) {
    for (const bool and_power : {false, true}) {
        auto journal = open();
        const std::string birth = and_power ? "b2" : "b1";
        make(*journal, birth, birth, 0);
        ASSERT_FALSE(journal->append(entry(birth, 1)));
        disk_.fail(Work::Sync, Fault::Io, 0, 1);
        ASSERT_TRUE(journal->append(entry(birth, 2)));
        expect_entries(*journal, birth, 1);
        // Shorter than the one that failed: the rest of that one is behind it.
        ASSERT_FALSE(journal->append(entry(birth, 2, 10)));
        ASSERT_FALSE(journal->append(entry(birth, 3)));
        if (and_power) {
            disk_.cut();
            journal.reset();
            disk_.restore(std::nullopt);
            journal = open();
        } else {
            journal = reopen(std::move(journal));
        }
        const StoredSession stored = read(*journal, birth);
        ASSERT_EQ(stored.tail.size(), 3U);
        EXPECT_EQ(stored.tail[1], entry(birth, 2, 10));
        EXPECT_EQ(stored.tail[2], entry(birth, 3));
    }
}

TEST_F(DiskFaults, ACommitThatFailedLastIsGoneAfterAClose) {
    auto journal = open();
    make(*journal, "birth", "id", 0);
    ASSERT_FALSE(journal->append(entry("birth", 1)));
    disk_.fail(Work::Sync, Fault::Io, 0, 1);
    ASSERT_TRUE(journal->append(entry("birth", 2)));
    journal = reopen(std::move(journal));
    expect_entries(*journal, "birth", 1);
    EXPECT_FALSE(journal->append(entry("birth", 2)));
}

/// One after the other, each write and each sync of it fails once.
TEST_F(DiskFaults, LeaveASessionWholeOrNotThere) {
    for (const Work work : {Work::Write, Work::Sync}) {
        for (const Fault fault : {Fault::Full, Fault::Io}) {
            bool is_through = false;
            for (std::uint64_t after = 0; !is_through; ++after) {
                ASSERT_LT(after, 1000U);
                auto journal = open();
                const std::string mesh(20'000, 'm');
                disk_.fail(work, fault, after, 1);
                const Committed outcome = journal->create(facts("birth", "id"), head(1), mesh);
                is_through = disk_.failures() == 0;
                disk_.mend();
                EXPECT_EQ(outcome.has_value(), !is_through);
                EXPECT_EQ(rows(*journal).size(), outcome ? 0U : 1U);
                if (outcome) make(*journal, "birth", "id", 1, mesh);  // the id is free again
                journal = reopen(std::move(journal));
                EXPECT_EQ(read(*journal, "birth").bytes, mesh);
                journal.reset();
                std::filesystem::remove_all(options_.folder);
                disk_.restore(std::nullopt);
                std::filesystem::remove_all(options_.folder);
            }
        }
    }
}

TEST_F(DiskFaults, LeaveTheOldSnapshotWhereTheNewOneFails) {
    bool is_through = false;
    for (std::uint64_t after = 0; !is_through; ++after) {
        ASSERT_LT(after, 1000U);
        auto journal = open();
        make(*journal, "birth", "id", 0, std::string(9000, 'a'));
        for (std::uint64_t version = 1; version <= 5; ++version)
            ASSERT_FALSE(journal->append(entry("birth", version)));
        disk_.fail(Work::Write, after % 2 == 0 ? Fault::Full : Fault::Io, after, 1);
        const std::string mesh(20'000, 'b');
        const Committed outcome = journal->write_snapshot("birth", head(3), mesh);
        is_through = disk_.failures() == 0;
        disk_.mend();
        for (int i = 0; i < 2; ++i) {
            expect_entries(*journal, "birth", 5);
            EXPECT_EQ(read(*journal, "birth").bytes, outcome ? std::string(9000, 'a') : mesh);
            journal = reopen(std::move(journal));
        }
        ASSERT_FALSE(journal->append(entry("birth", 6)));
        journal.reset();
        std::filesystem::remove_all(options_.folder);
        disk_.restore(std::nullopt);
        std::filesystem::remove_all(options_.folder);
    }
}

TEST_F(DiskFaults, PartsOfASnapshotThatWasNeverFinishedAreDropped) {
    auto journal = open();
    make(*journal, "birth", "id", 0);
    disk_.cut_after_syncs(20);
    const std::string mesh(200'000, 'm');
    ASSERT_TRUE(journal->write_snapshot("birth", head(0), mesh));
    journal.reset();
    disk_.restore(std::nullopt);
    journal = open();
    ASSERT_TRUE(comes_true([&] { return journal->figures().swept_rows >= 15; }));
    EXPECT_EQ(read(*journal, "birth").bytes, "mesh");
    ASSERT_FALSE(journal->write_snapshot("birth", head(0), std::string(60'000, 'm')));
    EXPECT_EQ(read(*journal, "birth").bytes.size(), 60'000U);
    journal = reopen(std::move(journal));
    EXPECT_LT(journal->figures().file_bytes, 150'000U) << "their room is used again";
    EXPECT_EQ(read(*journal, "birth").bytes.size(), 60'000U);
}

TEST_F(DiskFaults, WhileTheLogIsMovedIsTold) {
    options_.log_pages = 20;
    auto journal = open();
    make(*journal, "birth", "id", 0);
    std::uint64_t version = 0;
    std::mt19937_64 random(3);
    bool was_ill = false;
    for (int i = 0; i < 300; ++i) {
        if (i % 5 == 0) disk_.fail(Work::Sync, Fault::Io, random() % 12, 1);
        if (!journal->append(entry("birth", version + 1))) ++version;
        was_ill = was_ill || !journal->health().fine;
    }
    disk_.mend();
    EXPECT_TRUE(was_ill);
    ASSERT_TRUE(comes_true([&] { return journal->health().fine; }));
    EXPECT_GT(journal->figures().checkpoints, 5U);
    expect_entries(*journal, "birth", version);
    disk_.cut();
    journal.reset();
    disk_.restore(std::nullopt);
    journal = open();
    expect_entries(*journal, "birth", version);
}

TEST_F(DiskFaults, DoNotKeepAnAnswerFromTheNextCommit) {
    auto journal = open();
    make(*journal, "birth", "id", 0);
    disk_.fail(Work::Write, Fault::Full, 0, kForEver);
    const KeptAnswerRow answer{"birth", "key", "print", 9, "bytes"};
    journal->keep_answer(answer);
    journal->touch("birth", 99);
    ASSERT_TRUE(journal->append(entry("birth", 1)));
    disk_.mend();
    ASSERT_FALSE(journal->append(entry("birth", 1)));
    EXPECT_EQ(std::get<0>(journal->answers(0)), std::vector{answer});
    EXPECT_EQ(rows(*journal)[0].session.used, 99);
}

TEST_F(DiskFaults, AtTheStartAreWords) {
    disk_.fail(Work::Write, Fault::Full, 0, kForEver);
    EXPECT_NE(why_not().find("full"), std::string::npos) << why_not();
    disk_.mend();
    auto journal = open();
    ASSERT_TRUE(journal);
    make(*journal, "birth", "id");
    disk_.fail(Work::Sync, Fault::Io, 0, kForEver);
    journal.reset();
    disk_.mend();
    journal = open();
    EXPECT_EQ(rows(*journal).size(), 1U);
}

}  // namespace
}  // namespace tinsmith::server
