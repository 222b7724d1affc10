// SPDX-License-Identifier: Apache-2.0
#include "server/store/journal.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/server/store/journal_folder.hpp"

namespace tinsmith::server {
namespace {

using Kind = JournalFault::Kind;

class JournalTest : public JournalFolder {
  protected:
    static Kind kind(const Committed& outcome) {
        EXPECT_TRUE(outcome) << "it was done";
        return outcome ? outcome->kind : Kind::Io;
    }

    /// Until what is dropped at leisure is gone.
    template <typename Condition>
    static bool comes_true(const Condition& condition) {
        for (int i = 0; i < 2000; ++i) {
            if (condition()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return false;
    }
};

TEST_F(JournalTest, GivesBackWhatWasWritten) {
    auto journal = open();
    make(*journal, "birth", "id", 7, "the mesh");
    for (std::uint64_t version = 8; version <= 20; ++version)
        ASSERT_FALSE(journal->append(entry("birth", version)));
    const StoredSession stored = read(*journal, "birth");
    EXPECT_EQ(stored.bytes, "the mesh");
    EXPECT_EQ(stored.head, head(7, 8));
    ASSERT_EQ(stored.tail.size(), 13U);
    for (std::size_t i = 0; i < stored.tail.size(); ++i)
        EXPECT_EQ(stored.tail[i], entry("birth", 8 + i));
    journal = reopen(std::move(journal));
    const StoredSession again = read(*journal, "birth");
    EXPECT_EQ(again.bytes, stored.bytes);
    EXPECT_EQ(again.tail, stored.tail);
}

TEST_F(JournalTest, TakesBytesOfEverySort) {
    auto journal = open();
    const std::string odd("\0'\"\xff;--\n", 8);
    const StoredFacts session{odd, odd, "", "", odd, -5};
    ASSERT_FALSE(journal->create(session, {0, 0, 0, odd, "", 0}, ""));
    const JournalEntry empty{odd, 1, 0xffffffff, "", "", "", "", ""};
    const JournalEntry large{odd, 2, 0, std::string(300'000, '\0'), odd, odd, odd, odd};
    ASSERT_FALSE(journal->append(empty));
    ASSERT_FALSE(journal->append(large));
    const StoredSession stored = read(*journal, odd);
    EXPECT_EQ(stored.bytes, "");
    EXPECT_EQ(stored.head.digest, odd);
    EXPECT_EQ(stored.tail, (std::vector{empty, large}));
    EXPECT_EQ(rows(*journal).at(0).session, session);
}

TEST_F(JournalTest, ListsTheNewestOfEachSession) {
    auto journal = open();
    make(*journal, "b1", "one", 3);
    make(*journal, "b2", "two", 1);
    for (std::uint64_t version = 4; version <= 6; ++version)
        ASSERT_FALSE(journal->append(entry("b1", version)));
    for (int i = 0; i < 2; ++i) {
        const auto sessions = rows(*journal);
        ASSERT_EQ(sessions.size(), 2U);
        EXPECT_EQ(sessions[0].session, facts("b1", "one"));
        EXPECT_EQ(sessions[0].version, 6U);
        EXPECT_EQ(sessions[0].view, "view b1 6");
        EXPECT_EQ(sessions[0].snapshot_version, 3U);
        EXPECT_EQ(sessions[1].session, facts("b2", "two"));
        EXPECT_EQ(sessions[1].version, 1U);
        EXPECT_EQ(sessions[1].view, "view 1");
        EXPECT_EQ(sessions[0].damage + sessions[1].damage, "");
        journal = reopen(std::move(journal));
    }
}

TEST_F(JournalTest, KeepsTheOrderOfVersions) {
    auto journal = open();
    make(*journal, "birth", "id", 1);
    EXPECT_EQ(kind(journal->append(entry("birth", 1))), Kind::Conflict);
    EXPECT_EQ(kind(journal->append(entry("birth", 3))), Kind::Conflict);
    ASSERT_FALSE(journal->append(entry("birth", 2)));
    const Committed again = journal->append(entry("birth", 2));
    EXPECT_EQ(kind(again), Kind::Conflict);
    EXPECT_EQ(again->text, "version 2 cannot follow version 2 of session birth");
    EXPECT_EQ(kind(journal->append(entry("other", 2))), Kind::Gone);
    EXPECT_EQ(read(*journal, "birth").tail.size(), 1U);
    EXPECT_TRUE(journal->health().fine) << "none of that is the disk's fault";
}

TEST_F(JournalTest, RefusesIdsAndBirthsThatAreTaken) {
    auto journal = open();
    make(*journal, "b1", "id");
    EXPECT_EQ(kind(journal->create(facts("b2", "id"), head(1), "")), Kind::Conflict);
    EXPECT_EQ(kind(journal->create(facts("b1", "id2"), head(1), "")), Kind::Conflict);
    EXPECT_EQ(kind(journal->create(facts("", "id2"), head(1), "")), Kind::Conflict);
    make(*journal, "b2", "id2");
    journal = reopen(std::move(journal));
    EXPECT_EQ(kind(journal->create(facts("b3", "id2"), head(1), "")), Kind::Conflict);
    ASSERT_FALSE(journal->remove("b2"));
    make(*journal, "b3", "id2");
}

TEST_F(JournalTest, OfManyThatMakeOneIdOneDoes) {
    auto journal = open();
    std::atomic<int> made{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([&, i] {
            const Committed outcome = journal->create(facts("b" + std::to_string(i), "id"), head(1),
                                                      std::string(50'000, 'x'));
            if (!outcome) ++made;
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(made, 1);
    EXPECT_EQ(rows(*journal).size(), 1U);
}

TEST_F(JournalTest, RemovesASessionWhole) {
    options_.part_bytes = 1000;
    auto journal = open();
    make(*journal, "b1", "one", 1, std::string(9000, 'x'));
    make(*journal, "b2", "two");
    ASSERT_FALSE(journal->append(entry("b1", 2)));
    ASSERT_FALSE(journal->remove("b1"));
    EXPECT_EQ(kind(journal->remove("b1")), Kind::Gone);
    EXPECT_EQ(kind(journal->append(entry("b1", 3))), Kind::Gone);
    EXPECT_EQ(kind(journal->write_snapshot("b1", head(2), "")), Kind::Gone);
    EXPECT_EQ(std::get<JournalFault>(journal->read("b1")).kind, Kind::Gone);
    EXPECT_EQ(rows(*journal).size(), 1U);
    journal = reopen(std::move(journal));
    EXPECT_EQ(rows(*journal).size(), 1U);
    EXPECT_EQ(kind(journal->append(entry("b1", 3))), Kind::Gone);
}

TEST_F(JournalTest, StartsAtTheLastSnapshot) {
    options_.part_bytes = 1000;
    auto journal = open();
    make(*journal, "birth", "id", 1, std::string(5500, 'a'));
    for (std::uint64_t version = 2; version <= 9; ++version)
        ASSERT_FALSE(journal->append(entry("birth", version)));
    EXPECT_EQ(kind(journal->write_snapshot("birth", head(10), "x")), Kind::Conflict);
    EXPECT_EQ(kind(journal->write_snapshot("birth", head(0), "x")), Kind::Conflict);
    const std::string second = std::string(12'345, 'b') + "end";
    ASSERT_FALSE(journal->write_snapshot("birth", head(7), second));
    EXPECT_EQ(kind(journal->write_snapshot("birth", head(6), "x")), Kind::Conflict);
    for (int i = 0; i < 2; ++i) {
        const StoredSession stored = read(*journal, "birth");
        EXPECT_EQ(stored.bytes, second);
        EXPECT_EQ(stored.head, head(7, second.size()));
        ASSERT_EQ(stored.tail.size(), 2U);
        EXPECT_EQ(stored.tail[0], entry("birth", 8));
        EXPECT_EQ(stored.tail[1], entry("birth", 9));
        journal = reopen(std::move(journal));
    }
    // One that has no entries after it still tells what listings show.
    ASSERT_FALSE(journal->write_snapshot("birth", head(9), "third"));
    EXPECT_EQ(rows(*journal).at(0).view, "view 9");
    EXPECT_EQ(rows(*journal).at(0).version, 9U);
    journal = reopen(std::move(journal));
    EXPECT_EQ(rows(*journal).at(0).view, "view 9");
    ASSERT_FALSE(journal->append(entry("birth", 10)));
}

TEST_F(JournalTest, DropsWhatCountsNoMoreAndUsesItsRoomAgain) {
    options_.part_bytes = 20'000;
    options_.log_pages = 200;
    auto journal = open();
    const std::string bytes(400'000, 'x');
    make(*journal, "birth", "id", 1, bytes);
    std::uint64_t version = 1;
    std::uint64_t most = 0;
    std::uint64_t rows_to_drop = 0;
    for (int i = 0; i < 12; ++i) {
        for (int k = 0; k < 20; ++k)
            ASSERT_FALSE(journal->append(entry("birth", ++version)));
        ASSERT_FALSE(journal->write_snapshot("birth", head(version), bytes));
        rows_to_drop += 20 + 20;
        ASSERT_TRUE(comes_true([&] { return journal->figures().swept_rows == rows_to_drop; }))
            << journal->figures().swept_rows << " of " << rows_to_drop;
        if (i < 3) most = journal->figures().file_bytes + journal->figures().log_bytes;
    }
    EXPECT_LT(journal->figures().file_bytes, 2 * most);
    EXPECT_LT(journal->figures().log_bytes, 4 * 200 * 4096U) << "it begins anew once it is moved";
    EXPECT_GT(journal->figures().checkpoints, 4U);
    EXPECT_EQ(read(*journal, "birth").bytes, bytes);
    ASSERT_FALSE(journal->remove("birth"));
    journal = reopen(std::move(journal));
    make(*journal, "b2", "id", 1, bytes);
    EXPECT_EQ(read(*journal, "b2").bytes, bytes);
}

TEST_F(JournalTest, GrowsTheLogOnce) {
    options_.grow_log = true;
    std::uint64_t file_bytes = 0;
    for (int i = 0; i < 3; ++i) {
        auto journal = open();
        const std::string birth = "b" + std::to_string(i);
        ASSERT_FALSE(journal->create(facts(birth, birth), head(0), "mesh"));
        ASSERT_TRUE(comes_true([&] { return journal->figures().swept_rows == 1; }));
        const std::uint64_t log = journal->figures().log_bytes;
        EXPECT_GT(log, 4096U * static_cast<std::uint64_t>(options_.log_pages));
        for (std::uint64_t version = 1; version <= 100; ++version)
            ASSERT_FALSE(journal->append(entry(birth, version)));
        EXPECT_EQ(journal->figures().log_bytes, log) << "it is written over";
        if (i == 0) file_bytes = journal->figures().file_bytes;
        EXPECT_LT(journal->figures().file_bytes, file_bytes + 500'000);
        EXPECT_EQ(read(*journal, birth).tail.size(), 100U);
    }
}

TEST_F(JournalTest, CommitsForAllWhoWait) {
    auto journal = open();
    constexpr int kThreads = 16;
    constexpr std::uint64_t kEach = 40;
    for (int i = 0; i < kThreads; ++i)
        make(*journal, "b" + std::to_string(i), std::to_string(i), 0);
    const std::uint64_t before = journal->figures().commits;
    std::atomic<int> failures{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < kThreads; ++i) {
        threads.emplace_back([&, i] {
            for (std::uint64_t version = 1; version <= kEach; ++version)
                failures += journal->append(entry("b" + std::to_string(i), version)) ? 1 : 0;
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(failures, 0);
    const JournalFigures figures = journal->figures();
    EXPECT_EQ(figures.entries, kThreads * kEach);
    EXPECT_LT(figures.commits - before, kThreads * kEach / 2);
    EXPECT_GT(figures.largest_group, 2U);
    EXPECT_GT(figures.commit_seconds, 0.0);
    EXPECT_EQ(figures.queued_entries, 0U);
    EXPECT_EQ(figures.queued_bytes, 0U);
    std::uint64_t told = 0;
    for (const std::uint64_t number : figures.commits_within)
        told += number;
    EXPECT_EQ(told, figures.commits);
    for (int i = 0; i < kThreads; ++i)
        EXPECT_EQ(read(*journal, "b" + std::to_string(i)).tail.size(), kEach);
}

TEST_F(JournalTest, KeepsToTheBoundsOfGroupAndQueue) {
    options_.group_entries = 3;
    options_.queue_entries = 4;
    options_.queue_bytes = 2000;
    auto journal = open();
    std::vector<std::thread> threads;
    std::atomic<int> failures{0};
    for (int i = 0; i < 12; ++i)
        make(*journal, "b" + std::to_string(i), std::to_string(i), 0);
    for (int i = 0; i < 12; ++i) {
        threads.emplace_back([&, i] {
            for (std::uint64_t version = 1; version <= 10; ++version) {
                // Every fifth is larger than the queue takes of all.
                const std::size_t size = version % 5 == 0 ? 5000 : 100;
                const auto fault = journal->append(entry("b" + std::to_string(i), version, size));
                failures += fault ? 1 : 0;
                EXPECT_LE(journal->figures().queued_entries, 4U);
            }
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(failures, 0);
    EXPECT_LE(journal->figures().largest_group, 3U);
}

TEST_F(JournalTest, EntriesGoBetweenThePartsOfASnapshot) {
    options_.part_bytes = 50'000;
    auto journal = open();
    make(*journal, "small", "small", 0);
    std::atomic<bool> is_done{false};
    const std::string bytes(6'000'000, 'x');
    std::thread other([&] {
        EXPECT_FALSE(journal->create(facts("large", "large"), head(1), bytes));
        is_done = true;
    });
    std::uint64_t between = 0;
    for (std::uint64_t version = 1; !is_done; ++version) {
        ASSERT_FALSE(journal->append(entry("small", version)));
        if (journal->figures().written_bytes < bytes.size()) between = version;
        if (rows(*journal).size() == 1) continue;
        EXPECT_EQ(read(*journal, "large").bytes.size(), bytes.size()) << "it is there in part";
    }
    other.join();
    EXPECT_GT(between, 10U);
    EXPECT_EQ(read(*journal, "large").bytes, bytes);
}

TEST_F(JournalTest, KeepsTimesAndAnswersWithoutWaiting) {
    auto journal = open();
    make(*journal, "birth", "id");
    journal->touch("birth", 5000);
    journal->touch("birth", 6000);
    journal->touch("nobody", 6000);
    const KeptAnswerRow one{"birth", "k1", "p1", 100, std::string(5000, 'a')};
    const KeptAnswerRow two{"", "k2", "p2", 200, ""};
    journal->keep_answer(one);
    journal->keep_answer(two);
    // Without a commit that they could go with.
    ASSERT_TRUE(comes_true([&] { return rows(*journal)[0].session.used == 6000; }));
    EXPECT_EQ(std::get<0>(journal->answers(0)), (std::vector{one, two}));
    EXPECT_EQ(std::get<0>(journal->answers(100)), std::vector{two});
    journal->touch("birth", 7000);
    journal = reopen(std::move(journal));
    EXPECT_EQ(rows(*journal)[0].session.used, 7000);
    journal->forget_answers(150);
    ASSERT_TRUE(comes_true([&] { return std::get<0>(journal->answers(0)).size() == 1; }));
    EXPECT_EQ(std::get<0>(journal->answers(0)), std::vector{two});
    journal->keep_answer(one);
    journal = reopen(std::move(journal));
    EXPECT_EQ(std::get<0>(journal->answers(0)), (std::vector{two, one}));
}

TEST_F(JournalTest, BoundsTheAnswersThatItKeeps) {
    options_.waiting_answer_bytes = 100'000;
    options_.stored_answer_bytes = 1'000'000;
    auto journal = open();
    make(*journal, "birth", "id", 0);
    std::uint64_t version = 0;
    for (int i = 0; i < 300; ++i) {
        journal->keep_answer({"birth", std::to_string(i), "", i, std::string(10'000, 'a')});
        if (i % 5 != 4) continue;
        ASSERT_FALSE(journal->append(entry("birth", ++version)));
    }
    EXPECT_EQ(journal->figures().answers_dropped, 0U);
    ASSERT_TRUE(comes_true([&] { return std::get<0>(journal->answers(-1)).size() <= 100; }));
    EXPECT_EQ(std::get<0>(journal->answers(-1)).back().key, "299");
    for (int i = 0; i < 50; ++i)
        journal->keep_answer({"birth", "x", "", 1000, std::string(10'000, 'a')});
    EXPECT_GE(journal->figures().answers_dropped, 30U);
}

TEST_F(JournalTest, TakesNothingOnOnceItIsClosed) {
    auto journal = open();
    make(*journal, "birth", "id", 0);
    std::atomic<bool> is_closing{false};
    std::uint64_t done = 0;
    std::thread thread([&] {
        for (std::uint64_t version = 1;; ++version) {
            const bool closing = is_closing;
            if (const auto fault = journal->append(entry("birth", version))) {
                EXPECT_EQ(fault->kind, Kind::Closed);
                EXPECT_TRUE(is_closing || closing);
                return;
            }
            done = version;
        }
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    is_closing = true;
    journal->close();
    thread.join();
    EXPECT_EQ(kind(journal->create(facts("b", "i"), head(1), "")), Kind::Closed);
    EXPECT_EQ(kind(journal->remove("birth")), Kind::Closed);
    EXPECT_EQ(std::get<JournalFault>(journal->read("birth")).kind, Kind::Closed);
    EXPECT_EQ(std::get<JournalFault>(journal->sessions()).kind, Kind::Closed);
    EXPECT_FALSE(std::filesystem::exists(file().string() + "-wal")) << "all is in one file";
    journal = reopen(std::move(journal));
    EXPECT_EQ(rows(*journal)[0].version, done);
}

}  // namespace
}  // namespace tinsmith::server
