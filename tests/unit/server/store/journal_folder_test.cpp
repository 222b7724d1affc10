// SPDX-License-Identifier: Apache-2.0
// What a folder is taken for, and copies of it.
#include "tests/unit/server/store/journal_folder.hpp"

#include <atomic>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace tinsmith::server {
namespace {

namespace fs = std::filesystem;

class StoreFolder : public JournalFolder {
  protected:
    void put(const std::string& bytes) const {
        fs::create_directories(options_.folder);
        std::ofstream(file(), std::ios::binary) << bytes;
    }
    std::string bytes() const {
        std::ifstream in(file(), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    static bool has(const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    }
};

TEST_F(StoreFolder, IsMadeForItsOwnerAlone) {
    options_.folder = folder_ / "a" / "b" / "";
    auto journal = open();
    ASSERT_TRUE(journal);
    EXPECT_EQ(fs::status(options_.folder).permissions(), fs::perms::owner_all);
}

TEST_F(StoreFolder, IsServedFromByOneAtATime) {
    auto journal = open();
    const std::string why = why_not();
    EXPECT_TRUE(has(why, "is in use by another server (process ")) << why;
    EXPECT_TRUE(has(why, options_.folder.string())) << why;
    journal = reopen(std::move(journal));
    EXPECT_TRUE(journal);
}

TEST_F(StoreFolder, IsRefusedWhereItHoldsAnothersFile) {
    put("This is no database but a text, and longer than the head of one would be. " +
        std::string(200, '.'));
    EXPECT_TRUE(has(why_not(), "is no store of Tinsmith")) << why_not();
    EXPECT_TRUE(bytes().starts_with("This is no database")) << "it is as it was";
    fs::remove(file());
    // A database of another program.
    { auto journal = open(); }
    std::string foreign = bytes();
    foreign[68] = 'X';  // the application's number
    put(foreign);
    EXPECT_TRUE(has(why_not(), "another program made it")) << why_not();
    EXPECT_EQ(bytes(), foreign);
}

TEST_F(StoreFolder, IsRefusedWhereItsFormatIsNewer) {
    {
        auto journal = open();
        make(*journal, "birth", "id");
    }
    std::string newer = bytes();
    newer[63] = 2;  // the last byte of the user's version
    put(newer);
    EXPECT_TRUE(has(why_not(), "has format 2, and this program knows format 1")) << why_not();
    EXPECT_EQ(bytes(), newer);
}

TEST_F(StoreFolder, IsRefusedWhereItIsNone) {
    std::ofstream(options_.folder) << "a file";
    EXPECT_TRUE(has(why_not(), "is no folder")) << why_not();
    options_.folder = options_.folder / "below";
    EXPECT_TRUE(has(why_not(), options_.folder.string())) << why_not();
}

TEST_F(StoreFolder, WithAnEmptyFileIsANewStore) {
    put("");
    auto journal = open();
    ASSERT_TRUE(journal);
    make(*journal, "birth", "id");
}

TEST_F(StoreFolder, IsCopiedWhileOthersWrite) {
    constexpr std::size_t kThreads = 4;
    auto journal = open();
    std::vector<std::atomic<std::uint64_t>> acknowledged(kThreads);
    const auto birth = [](std::size_t i) { return "b" + std::to_string(i); };
    for (std::size_t i = 0; i < kThreads; ++i)
        make(*journal, birth(i), std::to_string(i), 0, std::string(200'000, 'm'));
    std::atomic<bool> is_done{false};
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < kThreads; ++i) {
        threads.emplace_back([&, i] {
            for (std::uint64_t version = 1; !is_done; ++version) {
                EXPECT_FALSE(journal->append(entry(birth(i), version)));
                acknowledged[i] = version;
                if (version % 50 != 0) continue;
                EXPECT_FALSE(journal->write_snapshot(birth(i), head(version), "short"));
            }
        });
    }
    for (int copy = 0; copy < 5; ++copy) {
        std::this_thread::sleep_for(std::chrono::milliseconds(40));
        std::vector<std::uint64_t> before(acknowledged.begin(), acknowledged.end());
        const fs::path to = folder_ / ("copy " + std::to_string(copy));
        const auto why = backup_store(options_.folder, to);
        ASSERT_FALSE(why) << *why;
        JournalOptions options;
        options.folder = to;
        auto opened = Journal::open(options);
        ASSERT_EQ(opened.index(), 0U) << std::get<1>(opened);
        const Journal& copied = *std::get<0>(opened);
        ASSERT_EQ(rows(copied).size(), kThreads);
        for (std::size_t i = 0; i < kThreads; ++i) {
            const StoredSession stored = read(copied, birth(i));
            std::uint64_t version = stored.head.version;
            for (const JournalEntry& one : stored.tail)
                EXPECT_EQ(one, entry(birth(i), ++version));
            EXPECT_GE(version, before[i]);
        }
    }
    is_done = true;
    for (std::thread& thread : threads)
        thread.join();
}

TEST_F(StoreFolder, IsCopiedOverNothing) {
    {
        auto journal = open();
        make(*journal, "birth", "id");
    }
    const fs::path to = folder_ / "copy";
    fs::create_directories(to);
    ASSERT_FALSE(backup_store(options_.folder, to)) << "an empty folder will do";
    const auto again = backup_store(options_.folder, to);
    ASSERT_TRUE(again);
    EXPECT_TRUE(has(*again, "nothing is written over")) << *again;
    std::ofstream(folder_ / "file") << "x";
    EXPECT_TRUE(backup_store(options_.folder, folder_ / "file"));
    const auto none = backup_store(folder_ / "nowhere", folder_ / "other");
    ASSERT_TRUE(none);
    EXPECT_TRUE(has(*none, "holds no store")) << *none;
    EXPECT_FALSE(fs::exists(folder_ / "other")) << "there is no half copy";
    put("no database at all, but text that is long enough to be looked at" + std::string(100, '.'));
    const auto foreign = backup_store(options_.folder, folder_ / "other");
    ASSERT_TRUE(foreign);
    EXPECT_TRUE(has(*foreign, "is no store of Tinsmith")) << *foreign;
    EXPECT_FALSE(fs::exists(folder_ / "other"));
    EXPECT_TRUE(backup_store(options_.folder, folder_ / "not" / "there"));
}

}  // namespace
}  // namespace tinsmith::server
