// SPDX-License-Identifier: Apache-2.0
#include "server/keys/key_file.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "server/digest.hpp"
#include "server/hex.hpp"
#include "server/keys/key_ring.hpp"

namespace tinsmith::server {
namespace {

const std::string kHash(64, 'a');
const std::string kLine = "alice 01ab " + kHash + " 2026-11-26T13:00:00Z";

Keys keys_in(const std::string& text) {
    auto read = parse_keys(text, "keys");
    if (const auto* faults = std::get_if<KeyFaults>(&read)) {
        for (const std::string& fault : *faults)
            ADD_FAILURE() << fault;
        return {};
    }
    return std::get<Keys>(read);
}

KeyFaults faults_in(const std::string& text) {
    auto read = parse_keys(text, "keys");
    return std::holds_alternative<Keys>(read) ? KeyFaults{} : std::get<KeyFaults>(read);
}

TEST(ApiKey, IsLongRandomAndToldByItsPrefix) {
    const std::string key = new_key();
    EXPECT_EQ(key.substr(0, 4), "tin_");
    EXPECT_EQ(from_hex(key.substr(4)).value().size(), 32U);
    EXPECT_NE(key, new_key());
    EXPECT_NE(new_key_id(), new_key_id());
    EXPECT_TRUE(is_key_name(new_key_id()));
}

TEST(ApiKey, IsKeptAsItsSha256) {
    // sha256sum says so.
    EXPECT_EQ(hex_of(hash_of_key("abc")),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(hex_of(hash_of_key("")),
              "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(SameInConstantTime, ComparesAllBytes) {
    const std::string text(32, 'x');
    EXPECT_TRUE(same_in_constant_time(text, std::string(text)));
    EXPECT_TRUE(same_in_constant_time("", ""));
    EXPECT_FALSE(same_in_constant_time(text, text + "x"));
    for (std::size_t i = 0; i < text.size(); ++i) {
        std::string other = text;
        other[i] = static_cast<char>(other[i] ^ 1);
        EXPECT_FALSE(same_in_constant_time(text, other)) << i;
    }
}

TEST(KeyFile, ReadsWhatItWrites) {
    const Keys keys{{"alice", "01ab", std::string(32, 'x'), "2026-11-26T13:00:00Z", {}},
                    {"bob.of-the_city",
                     "02cd",
                     std::string(32, '\0'),
                     "2026-11-26T13:00:01Z",
                     {10, std::size_t{8} << 30, 0, 2.5}}};
    EXPECT_EQ(keys_in(write_keys(keys)), keys);
    EXPECT_NE(write_keys(keys).find("max_memory_bytes=8589934592 max_requests=0 "
                                    "max_requests_per_second=2.5\n"),
              std::string::npos);
    EXPECT_EQ(keys_in(kLine + " max_history=1 max_queued_jobs=0\n").at(0).quotas,
              (KeyQuotas{.max_history = 1, .max_queued_jobs = 0}));
    EXPECT_TRUE(keys_in("").empty());
    EXPECT_EQ(keys_in("\n  # a comment\n\t" + kLine + "  max_sessions=3\r\n").size(), 1U);
    EXPECT_EQ(keys_in(kLine).at(0).name, "alice") << "the last line may have no end";
}

TEST(KeyFile, TellsEveryFaultWithItsLine) {
    const auto faults = faults_in(
        "# keys\n"
        "alice 01ab\n" +
        kLine + " max_sesions=3 max_requests=-1\n" + "../x 02 " + kHash +
        " 2026-11-26T13:00:00Z\n"
        "carol 03 0123 noon\n"
        "dave 04 " +
        new_key() + " 2026-11-26T13:00:00Z\n");
    ASSERT_EQ(faults.size(), 7U);
    EXPECT_EQ(faults[0].substr(0, 8), "keys:2: ");
    EXPECT_NE(faults[1].find("keys:3: \"max_sesions=3\" is no quota: known are max_sessions,"),
              std::string::npos);
    EXPECT_NE(faults[2].find("keys:3: max_requests cannot be \"-1\""), std::string::npos);
    EXPECT_NE(faults[3].find("keys:4: the name \"../x\""), std::string::npos);
    EXPECT_NE(faults[4].find("keys:5: \"0123\" is no SHA-256"), std::string::npos);
    EXPECT_NE(faults[5].find("keys:5: \"noon\" is no time"), std::string::npos);
    EXPECT_NE(faults[6].find("keys:6: a key itself stands where its SHA-256 belongs"),
              std::string::npos);
    EXPECT_EQ(faults[6].find("tin_"), std::string::npos) << "it goes to the log";
}

TEST(KeyFile, RefusesTwoOfAKind) {
    const std::string other(64, 'b');
    EXPECT_EQ(faults_in(kLine + "\nalice 02 " + other + " 2026-11-26T13:00:00Z\n").size(), 1U);
    EXPECT_EQ(faults_in(kLine + "\nbob 01ab " + other + " 2026-11-26T13:00:00Z\n").size(), 1U);
    EXPECT_EQ(faults_in(kLine + "\nbob 02 " + kHash + " 2026-11-26T13:00:00Z\n").size(), 1U);
    EXPECT_EQ(faults_in(kLine + " max_sessions=1 max_sessions=2\n").size(), 1U);
    for (const char* bad : {"max_sessions=1.5", "max_sessions=", "max_sessions", "max_sessions=1x",
                            "max_requests_per_second=0", "max_requests_per_second=nan",
                            "max_memory_bytes=1e300", "max_sessions=inf", "=", "max_history=0"})
        EXPECT_EQ(faults_in(kLine + " " + bad + "\n").size(), 1U) << bad;
}

TEST(KeyFile, TellsAHundredFaultsAtMost) {
    std::string text;
    for (int i = 0; i < 1000; ++i)
        text += "x\n";
    EXPECT_EQ(faults_in(text).size(), 100U);
}

/// Whatever bytes a file has, its faults are lines that a log and a terminal can show.
TEST(KeyFile, TellsFaultsOfAnyBytesAsPlainText) {
    std::string text;
    for (int byte = 0; byte < 256; ++byte)
        text += std::string(1, static_cast<char>(byte)) + "\x1b[31m " + kHash + " x\n";
    for (const std::string& fault : faults_in(text))
        for (const char c : fault)
            EXPECT_TRUE(c >= 0x20 && c < 0x7f) << fault;
}

class KeyFolder : public ::testing::Test {
  protected:
    KeyFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "tinsmith-keys-XXXXXX");
        folder_ = ::mkdtemp(name.data());
    }
    ~KeyFolder() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }

    std::string path() const { return (folder_ / "keys").string(); }
    static KeyFaults add(const std::string& path, const std::string& name) {
        return change_key_file(path, [&](Keys& keys) -> std::optional<std::string> {
            keys.push_back({name, new_key_id(), hash_of_key(new_key()), time_of_making(), {}});
            return std::nullopt;
        });
    }
    static std::size_t count(const std::string& path) {
        const auto read = read_key_file(path, false);
        return std::holds_alternative<Keys>(read) ? std::get<Keys>(read).size() : SIZE_MAX;
    }

    std::filesystem::path folder_;
};

TEST_F(KeyFolder, IsWrittenForItsOwnerAlone) {
    const mode_t before = ::umask(0);
    EXPECT_TRUE(add(path(), "alice").empty());
    ::umask(before);
    struct stat status {};
    ASSERT_EQ(::stat(path().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0600U);
    EXPECT_EQ(count(path()), 1U);
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        if (entry.path() != path() && entry.path() != path() + ".lock") ++files;
    EXPECT_EQ(files, 0U) << "nothing is left lying about";
}

TEST_F(KeyFolder, IsAsItWasWhereTheChangeIsRefused) {
    EXPECT_TRUE(add(path(), "alice").empty());
    const auto faults = change_key_file(path(), [](Keys& keys) -> std::optional<std::string> {
        keys.clear();
        return "no";
    });
    EXPECT_EQ(faults, KeyFaults{"no"});
    EXPECT_EQ(count(path()), 1U);
    std::ofstream(path(), std::ios::app) << "nonsense\n";
    EXPECT_EQ(add(path(), "bob").size(), 1U) << "a file with faults is not written over";
    EXPECT_EQ(count(path()), SIZE_MAX);
    EXPECT_EQ(add((folder_ / "none" / "keys").string(), "bob").size(), 1U);
}

TEST_F(KeyFolder, LosesNoneOfManyThatComeAtOnce) {
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i)
        threads.emplace_back([this, i] {
            for (int j = 0; j < 5; ++j)
                EXPECT_TRUE(add(path(), "k" + std::to_string(i) + "." + std::to_string(j)).empty());
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(count(path()), 40U);
}

TEST_F(KeyFolder, IsFollowedThroughLinks) {
    std::filesystem::create_directory(folder_ / "real");
    std::filesystem::create_symlink(folder_ / "real" / "keys", path());
    EXPECT_TRUE(add((folder_ / "real" / "keys").string(), "alice").empty());
    EXPECT_TRUE(add(path(), "bob").empty());
    EXPECT_TRUE(std::filesystem::is_symlink(path()));
    EXPECT_EQ(count((folder_ / "real" / "keys").string()), 2U);
}

TEST_F(KeyFolder, MayBeMissingOrNot) {
    EXPECT_TRUE(std::get<Keys>(read_key_file(path(), true)).empty());
    EXPECT_EQ(std::get<KeyFaults>(read_key_file(path(), false)).size(), 1U);
    EXPECT_EQ(std::get<KeyFaults>(read_key_file(folder_.string(), true)).size(), 1U)
        << "a folder is no file";
}

TEST(KeyRing, FindsWhoseAKeyIs) {
    const std::string one = new_key(), other = new_key();
    const KeyRing ring({{"alice", "01", hash_of_key(one), "", {.max_sessions = 3}},
                        {"bob", "02", hash_of_key(other), "", {}}});
    EXPECT_EQ(ring.find(one).value().name, "alice");
    EXPECT_EQ(ring.find(one).value().quotas.max_sessions, 3U);
    EXPECT_EQ(ring.find(other).value().id, "02");
    for (std::string wrong : {std::string(), one + "0", one.substr(1), new_key(), one + other})
        EXPECT_FALSE(ring.find(wrong));
    std::string near = one;
    near.back() = near.back() == '0' ? '1' : '0';
    EXPECT_FALSE(ring.find(near));
}

TEST(KeyRing, OpensNothingWhereKeysGo) {
    KeyRing ring;
    EXPECT_FALSE(ring.wants_keys());
    const std::string key = new_key();
    ring.replace({{"alice", "01", hash_of_key(key), "", {}}});
    EXPECT_TRUE(ring.wants_keys());
    ring.replace({});
    EXPECT_TRUE(ring.wants_keys());
    EXPECT_FALSE(ring.find(key));
}

TEST(Asker, SeesItsOwnAndWhatIsNobodys) {
    const Asker alice{"01", "alice", {}};
    EXPECT_TRUE(alice.may_see("01"));
    EXPECT_TRUE(alice.may_see(""));
    EXPECT_FALSE(alice.may_see("02"));
    EXPECT_FALSE(alice.may_see("0"));
    EXPECT_TRUE(Asker{}.may_see("02"));
}

}  // namespace
}  // namespace tinsmith::server
