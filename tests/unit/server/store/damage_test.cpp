// SPDX-License-Identifier: Apache-2.0
// Bytes of the file that are not what was written.
#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/store/failing_disk.hpp"
#include "tests/unit/server/store/journal_folder.hpp"

namespace tinsmith::server {
namespace {

using Kind = JournalFault::Kind;

constexpr std::size_t kPage = 4096;
constexpr std::array<const char*, 3> kBirths = {"alpha", "beta", "gamma"};
constexpr std::uint64_t kNewest = 60;

/// Three sessions with some pages of entries each, and a file with one of them damaged.
class Damage : public JournalFolder {
  protected:
    void SetUp() override {
        JournalFolder::SetUp();
        options_.part_bytes = 10'000;
        options_.vfs = disk_.name();
        auto journal = open();
        for (const std::string birth : kBirths) {
            make(*journal, birth, "id of " + birth, 0, mesh(birth));
            for (std::uint64_t version = 1; version <= kNewest; ++version)
                ASSERT_FALSE(journal->append(entry(birth, version)));
        }
        journal.reset();
        std::ifstream in(file(), std::ios::binary);
        bytes_ = {std::istreambuf_iterator<char>(in), {}};
        whole_ = bytes_;
    }

    static std::string mesh(const std::string& birth) {
        std::string bytes;
        while (bytes.size() < 35'000)
            bytes += "mesh of " + birth + " at " + std::to_string(bytes.size()) + ";";
        return bytes;
    }

    /// The place of a text that is in the file once.
    std::size_t place_of(const std::string& text) const {
        const std::size_t place = bytes_.find(text);
        EXPECT_NE(place, std::string::npos) << text;
        EXPECT_EQ(bytes_.find(text, place + 1), std::string::npos) << text;
        return place;
    }
    /// Pages with entries of that session and of no other.
    std::vector<std::size_t> pages_of(const std::string& birth) const {
        std::vector<std::size_t> pages;
        for (std::size_t page = 0; page < bytes_.size(); page += kPage) {
            const std::string_view text = std::string_view(bytes_).substr(page, kPage);
            const bool is_only = std::all_of(kBirths.begin(), kBirths.end(), [&](auto other) {
                const bool has = text.find("body " + std::string(other)) != text.npos;
                return has == (other == birth);
            });
            if (is_only) pages.push_back(page);
        }
        EXPECT_FALSE(pages.empty());
        return pages;
    }
    void put() const { std::ofstream(file(), std::ios::binary) << bytes_; }

    static void expect_whole(const Journal& journal, const std::string& birth,
                             std::uint64_t newest = kNewest) {
        const StoredSession stored = read(journal, birth);
        EXPECT_EQ(stored.bytes, mesh(birth));
        ASSERT_EQ(stored.tail.size(), newest);
        for (std::uint64_t i = 0; i < newest; ++i)
            EXPECT_EQ(stored.tail[i], entry(birth, i + 1));
    }

    /// Of that one alone: the others are read and go on, and it is told by name.
    void expect_damaged(const std::string& damaged, const std::string& words) const {
        auto journal = open();
        ASSERT_TRUE(journal);
        for (const std::string birth : kBirths) {
            if (birth == damaged) {
                const auto result = journal->read(birth);
                ASSERT_TRUE(std::holds_alternative<JournalFault>(result)) << birth;
                const JournalFault fault = std::get<JournalFault>(result);
                EXPECT_EQ(fault.kind, Kind::Damaged);
                EXPECT_NE(fault.text.find(words), std::string::npos) << fault.text;
            } else {
                expect_whole(*journal, birth);
                EXPECT_FALSE(journal->append(entry(birth, kNewest + 1)));
            }
        }
        EXPECT_EQ(rows(*journal).size(), kBirths.size());
        EXPECT_TRUE(journal->health().fine);
    }

    /// From a thread for each session. What the last refusal was, by session; empty: none.
    static std::map<std::string, std::string> append_to_all(Journal& journal, int times) {
        std::map<std::string, std::string> refused;
        std::vector<std::thread> threads;
        for (const std::string birth : kBirths) {
            std::string& why = refused[birth];
            threads.emplace_back([&journal, &why, birth, times] {
                std::uint64_t newest = kNewest;
                for (int i = 0; i < times; ++i) {
                    if (const auto fault = journal.append(entry(birth, newest + 1))) {
                        EXPECT_EQ(fault->kind, Kind::Damaged);
                        why = fault->text;
                    } else {
                        ++newest;
                    }
                }
            });
        }
        for (std::thread& thread : threads)
            thread.join();
        return refused;
    }

    store_tests::FailingDisk disk_{"damage"};  // which syncs nothing: it is fast
    std::string bytes_;
    std::string whole_;
};

TEST_F(Damage, OfAnEntryIsThatOfItsSession) {
    bytes_[place_of("body beta 20") + 200] ^= 1;
    put();
    expect_damaged("beta", "entry of version 20 of session beta is not what was written");
}

TEST_F(Damage, OfEachMemberOfAnEntryIsSeen) {
    for (const char* member : {"view beta 31", "digest beta 31", "key beta 31", "print beta 31"}) {
        bytes_ = whole_;
        bytes_[place_of(member)] ^= 0x20;
        put();
        expect_damaged("beta", "entry of version 31 of session beta is not what was written");
    }
}

TEST_F(Damage, OfTheNewestEntryIsSeenInTheList) {
    bytes_[place_of("body gamma 60") + 1] ^= 4;
    put();
    expect_damaged("gamma", "entry of version 60");
    auto journal = open();
    const auto sessions = rows(*journal);
    EXPECT_NE(sessions[2].damage.find("entry of version 60"), std::string::npos);
    EXPECT_EQ(sessions[2].session, facts("gamma", "id of gamma"));
    const Committed refused = journal->append(entry("gamma", 61));
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->kind, Kind::Damaged);
    EXPECT_FALSE(journal->remove("gamma")) << "it can be removed all the same";
    EXPECT_EQ(rows(*journal).size(), 2U);
}

TEST_F(Damage, OfASnapshotIsThatOfItsSession) {
    bytes_[place_of(mesh("alpha").substr(6000, 60)) + 3] ^= 2;
    put();
    expect_damaged("alpha", "of the snapshot of session alpha is not what was written");
}

TEST_F(Damage, OfASessionsFactsIsToldWithWhatCanBeRead) {
    bytes_[place_of("facts of beta") + 9] ^= 1;
    put();
    auto journal = open();
    const auto sessions = rows(*journal);
    ASSERT_EQ(sessions.size(), 3U);
    EXPECT_EQ(sessions[1].damage,
              "row 2 of table session is not what was written: its checksum differs");
    EXPECT_EQ(sessions[1].session.id, "id of beta");
    expect_whole(*journal, "alpha");
    expect_whole(*journal, "gamma");
    EXPECT_FALSE(journal->append(entry("gamma", kNewest + 1)));
}

TEST_F(Damage, OfAPageIsThatOfTheSessionsOnIt) {
    // The second page: what begins and ends on it is beta's too.
    const std::size_t page = pages_of("beta").at(1);
    std::fill_n(bytes_.begin() + static_cast<std::ptrdiff_t>(page), 16, '\x7f');
    put();
    expect_damaged("beta", "the entries of session beta");
}

/// Reading does not look at the list of free blocks in a page, writing does.
TEST_F(Damage, ThatAnAppendComesUponStopsThatSessionAlone) {
    const std::size_t page = place_of("body beta 60") / kPage * kPage;
    bytes_[page + 1] = 0;
    bytes_[page + 2] = 1;
    bytes_[place_of("body beta 10") + 200] ^= 1;  // and one entry that nobody has looked at yet
    put();
    auto journal = open();
    EXPECT_EQ(rows(*journal)[1].damage, "") << "nothing of it has been seen";
    const auto refused = append_to_all(*journal, 50);
    EXPECT_EQ(refused.at("alpha") + refused.at("gamma"), "");
    const std::string& why = refused.at("beta");
    EXPECT_NE(why.find("the entries of session beta: writing to "), std::string::npos) << why;
    EXPECT_TRUE(journal->health().fine);
    for (const SessionRow& row : rows(*journal))
        EXPECT_EQ(row.damage, row.session.birth == "beta" ? why : "");
    for (int i = 0; i < 2; ++i) {
        expect_whole(*journal, "alpha", kNewest + 50);
        expect_whole(*journal, "gamma", kNewest + 50);
        journal = reopen(std::move(journal));
    }
}

TEST_F(Damage, ThatAnAppendComesUponIsLeftBehindWhereAllCanBeRead) {
    const std::size_t page = place_of("body beta 60") / kPage * kPage;
    bytes_[page + 1] = 0;
    bytes_[page + 2] = 1;
    put();
    auto journal = open();
    journal->touch("beta", 4321);
    const auto refused = append_to_all(*journal, 50);
    EXPECT_EQ(refused.at("alpha") + refused.at("beta") + refused.at("gamma"), "");
    for (int i = 0; i < 2; ++i) {
        for (const std::string birth : kBirths)
            expect_whole(*journal, birth, kNewest + 50);
        EXPECT_EQ(rows(*journal).size(), 3U);
        EXPECT_EQ(rows(*journal).back().session.birth, "beta") << "moved to the end";
        EXPECT_EQ(rows(*journal).back().session.used, 4321);
        ASSERT_FALSE(journal->write_snapshot("beta", head(kNewest), mesh("beta")));
        EXPECT_EQ(read(*journal, "beta").tail.size(), 50U);
        if (i == 1) return;
        ASSERT_FALSE(journal->remove("beta"));
        make(*journal, "beta", "beta", 0, mesh("beta"));
        for (std::uint64_t version = 1; version <= kNewest + 50; ++version)
            ASSERT_FALSE(journal->append(entry("beta", version)));
        journal->touch("beta", 4321);
        journal = reopen(std::move(journal));
    }
}

TEST_F(Damage, OfAHoleInTheVersionsIsSeen) {
    // The key of the entry of version 30 says 31 and that of 31 stays: both are wrong or missing.
    const std::size_t body = place_of("view alpha 30");
    // Before the row's head: its length and its key, a number of 6 bytes with 7 bits in each.
    bool is_found = false;
    const unsigned char last = static_cast<unsigned char>(30);
    for (std::size_t i = body - 40; i < body && !is_found; ++i) {
        if (static_cast<unsigned char>(bytes_[i]) != last) continue;
        std::string changed = bytes_;
        changed[i] = 29;
        std::ofstream(file(), std::ios::binary) << changed;
        auto journal = open();
        const auto result = journal->read("alpha");
        is_found = std::holds_alternative<JournalFault>(result) &&
                   std::get<JournalFault>(result).kind == Kind::Damaged;
        expect_whole(*journal, "beta");
    }
    EXPECT_TRUE(is_found);
}

TEST_F(Damage, OfAFileThatWasCutOffIsTold) {
    for (std::size_t pages = 1; pages * kPage < whole_.size(); ++pages) {
        bytes_ = whole_.substr(0, pages * kPage);
        put();
        auto opened = try_open();
        if (opened.index() == 1) {
            EXPECT_NE(std::get<1>(opened).find(file().string()), std::string::npos);
            continue;
        }
        const Journal& journal = *std::get<0>(opened);
        for (const std::string birth : kBirths) {
            const auto result = journal.read(birth);
            if (const auto* fault = std::get_if<JournalFault>(&result)) {
                EXPECT_TRUE(fault->kind == Kind::Damaged || fault->kind == Kind::Gone);
            } else {
                expect_whole(journal, birth);
            }
        }
    }
}

/// Whatever the damage: no crash, no wrong byte, and who can be read goes on.
TEST_F(Damage, OfRandomBytesNeverGivesOtherBytes) {
    std::size_t damaged = 0;
    std::size_t shorter = 0;
    std::size_t refused = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(seed);
        bytes_ = whole_;
        const std::size_t place = random() % bytes_.size();
        switch (seed % 3) {
            case 0:
                bytes_[place] = static_cast<char>(bytes_[place] ^ (1 << random() % 8));
                break;
            case 1:
                // The heads of pages are few and matter most.
                for (std::size_t i = 0; i < 4; ++i)
                    bytes_[place / kPage * kPage + random() % 16] = static_cast<char>(random());
                break;
            default:
                std::fill_n(bytes_.begin() + static_cast<std::ptrdiff_t>(place / 512 * 512), 512,
                            static_cast<char>(random() % 2));
        }
        put();
        auto opened = try_open();
        if (opened.index() == 1) {
            ++refused;
            continue;
        }
        Journal& journal = *std::get<0>(opened);
        for (const std::string birth : kBirths) {
            const auto result = journal.read(birth);
            if (const auto* fault = std::get_if<JournalFault>(&result)) {
                EXPECT_TRUE(fault->kind == Kind::Damaged || fault->kind == Kind::Gone)
                    << fault->text;
                ++damaged;
                continue;
            }
            const auto& stored = std::get<StoredSession>(result);
            EXPECT_EQ(stored.bytes, mesh(birth));
            EXPECT_LE(stored.tail.size(), kNewest);
            shorter += stored.tail.size() < kNewest ? 1U : 0U;
            for (std::uint64_t i = 0; i < stored.tail.size(); ++i)
                EXPECT_EQ(stored.tail[i], entry(birth, i + 1));
            const auto fault = journal.append(entry(birth, stored.tail.size() + 1));
            EXPECT_TRUE(!fault || fault->kind != Kind::Io) << fault->text;
        }
    }
    std::printf("of %d: %zu sessions damaged, %zu shorter, %zu files refused\n", 1200, damaged,
                shorter, refused);
    EXPECT_GT(damaged, 30U);
    EXPECT_EQ(shorter, 0U);
}

}  // namespace
}  // namespace tinsmith::server
