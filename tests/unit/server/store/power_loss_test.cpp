// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "server/store/journal.hpp"
#include "tests/store/failing_disk.hpp"
#include "tests/unit/server/store/journal_folder.hpp"

namespace tinsmith::server {
namespace {

using store_tests::FailingDisk;

constexpr std::size_t kThreads = 4;

/// How often the power is cut; a long run takes more by the environment.
std::uint64_t rounds() {
    const char* text = std::getenv("TINSMITH_POWER_CUTS");
    return text == nullptr ? 200 : std::strtoull(text, nullptr, 10);
}

/// What one thread knows of its session.
struct Client {
    std::string birth;
    bool exists = false;     ///< it was acknowledged
    bool may_exist = false;  ///< it was asked for, or has not been removed for certain
    std::uint64_t acknowledged = 0;
    std::uint64_t asked = 0;
    std::uint64_t unsynced = 0;  ///< acknowledgements before which nothing was synced
    std::uint64_t acknowledgements = 0;
};

/// A mesh of some parts that follows from its session and version.
std::string mesh(const std::string& birth, std::uint64_t version) {
    std::mt19937_64 random(std::hash<std::string>{}(birth) ^ version);
    std::string bytes(random() % 20'000, ' ');
    for (char& byte : bytes)
        byte = static_cast<char>(random() & 0xffU);
    return bytes;
}

class PowerLoss : public JournalFolder {
  protected:
    void SetUp() override {
        JournalFolder::SetUp();
        options_.vfs = disk_.name();
        options_.part_bytes = 4096;
        options_.log_pages = 60;  // so that the power also goes while they are moved
    }

    /// The sync that makes it durable has to lie between the question and the answer.
    bool ask(Client& client, const std::function<Committed()>& question) {
        const std::uint64_t before = disk_.log_syncs();
        const bool done = !question();
        if (!done) return false;
        ++client.acknowledgements;
        if (disk_.log_syncs() == before) ++client.unsynced;
        return true;
    }

    void work(Journal& journal, Client& client, std::uint64_t seed) {
        std::mt19937_64 random(seed);
        while (!disk_.is_cut()) {
            if (!client.exists) {
                client.birth = "birth " + std::to_string(++births_);
                client.may_exist = true;
                client.acknowledged = client.asked = 1 + random() % 5;
                client.exists = ask(client, [&] {
                    return journal.create(facts(client.birth, client.birth), head(client.asked),
                                          mesh(client.birth, client.asked));
                });
                if (!client.exists) return;
                continue;
            }
            const std::uint64_t choice = random() % 40;
            if (choice == 0) {
                client.exists = false;
                if (!ask(client, [&] { return journal.remove(client.birth); })) return;
                client.may_exist = false;
            } else if (choice < 4) {
                const std::uint64_t version = client.acknowledged;
                if (!ask(client, [&] {
                        return journal.write_snapshot(client.birth, head(version),
                                                      mesh(client.birth, version));
                    }))
                    return;
            } else if (choice < 8) {
                journal.touch(client.birth, 77);
                journal.keep_answer({client.birth, "key", "print", 5, std::string(3000, 'a')});
            } else {
                client.asked = client.acknowledged + 1;
                if (!ask(client, [&] {
                        return journal.append(entry(client.birth, client.asked, random() % 6000));
                    }))
                    return;
                client.acknowledged = client.asked;
            }
        }
    }

    /// Nothing that was acknowledged is missing, and what is there is whole.
    static void check(const Journal& journal, Client& client) {
        auto result = journal.read(client.birth);
        if (const auto* fault = std::get_if<JournalFault>(&result)) {
            EXPECT_EQ(fault->kind, JournalFault::Kind::Gone) << fault->text;
            EXPECT_FALSE(client.exists) << client.birth << " is lost";
            client.exists = client.may_exist = false;
            return;
        }
        EXPECT_TRUE(client.may_exist) << client.birth << " was removed";
        const auto& stored = std::get<StoredSession>(result);
        EXPECT_EQ(stored.bytes, mesh(client.birth, stored.head.version));
        EXPECT_EQ(stored.head, head(stored.head.version, stored.bytes.size()));
        std::uint64_t version = stored.head.version;
        for (const JournalEntry& one : stored.tail)
            EXPECT_EQ(one, entry(client.birth, ++version, one.body.size()));
        EXPECT_GE(version, client.acknowledged) << client.birth << " has lost entries";
        EXPECT_LE(version, client.asked);
        client.exists = client.may_exist = true;
        client.acknowledged = client.asked = version;
    }

    FailingDisk disk_{"power-loss"};
    std::atomic<std::uint64_t> births_{0};
};

TEST_F(PowerLoss, LosesNothingThatWasAcknowledged) {
    std::vector<Client> clients(kThreads);
    std::uint64_t acknowledgements = 0;
    for (std::uint64_t round = 0; round < rounds() && !HasFailure(); ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        std::mt19937_64 random(round);
        options_.grow_log = round % 4 == 1;
        auto journal = open();
        ASSERT_TRUE(journal);
        for (Client& client : clients) {
            if (!client.birth.empty()) check(*journal, client);
            client.unsynced = client.acknowledgements = 0;
        }
        // Every tenth time it is closed first, and the power goes then or just before.
        const bool close_first = round % 10 == 9;
        disk_.cut_after_syncs(1 + random() % 60);
        std::vector<std::thread> threads;
        for (Client& client : clients) {
            threads.emplace_back(
                [this, &journal, &client, seed = random()] { work(*journal, client, seed); });
        }
        for (std::thread& thread : threads)
            thread.join();
        if (!close_first) disk_.cut();
        for (const Client& client : clients) {
            EXPECT_EQ(client.unsynced, 0U) << "acknowledged before a sync";
            acknowledgements += client.acknowledgements;
        }
        journal.reset();
        disk_.restore(round % 3 == 0 ? std::nullopt : std::optional(random()));
        if (round % 25 == 24) {  // with another file: they do not grow for ever
            std::filesystem::remove_all(options_.folder);
            clients.assign(kThreads, {});
        }
    }
    std::printf("%llu power cuts, %llu acknowledgements, %llu syncs of the log\n",
                static_cast<unsigned long long>(rounds()),
                static_cast<unsigned long long>(acknowledgements),
                static_cast<unsigned long long>(disk_.log_syncs()));
    EXPECT_GT(acknowledgements, rounds());
}

}  // namespace
}  // namespace tinsmith::server
