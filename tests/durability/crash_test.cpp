// SPDX-License-Identifier: Apache-2.0
// kill -9 at random moments while clients work and try again: after each start every acknowledged
// change is there at its version, no other one, and the meshes are those of a server that was never
// killed. TINSMITH_KILLS says how often, TINSMITH_SEED where the dice begin.
#include <chrono>
#include <csignal>
#include <iostream>
#include <list>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "tests/durability/crash_client.hpp"
#include "tests/durability/model.hpp"

namespace tinsmith::e2e {
namespace {

constexpr int kClients = 4;
constexpr int kKillsOfTheShortForm = 15;
/// So often all sessions are made anew: histories stay short enough to be told in one page.
constexpr int kKillsOfAnEpoch = 20;

int number_of(const char* name, int otherwise) {
    const char* text = std::getenv(name);
    return text == nullptr ? otherwise : std::atoi(text);
}

class Crash : public testing::Test {
  protected:
    Crash() {
        for (int i = 0; i < kClients; ++i)
            clients_.emplace_back(i, kClients, seed_ * 1000 + static_cast<std::uint64_t>(i),
                                  ledger_);
    }

    std::vector<std::string> arguments() const { return {"--data", folder_.file("data")}; }

    /// Starts it; before that, perhaps, starts that are killed before they are ready.
    void start() {
        while (dice_.chance(0.2)) {
            const std::string log = folder_.file("false-start");
            auto all = arguments();
            all.insert(all.begin(), {"serve", "--port", "0"});
            Program program(std::move(all), log);
            pause(dice_.between(0, 60));
            program.send_signal(SIGKILL);
            program.wait();
            ++false_starts_;
            EXPECT_EQ(complaints_in(program.output()), "");
        }
        server_.emplace(arguments());
        ASSERT_NE(server_->port(), 0) << server_->program().output();
    }

    static void pause(double milliseconds) {
        std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(milliseconds));
    }

    /// All sessions anew.
    void begin_epoch() {
        SteadyClient client(server_->port());
        for (const auto& [id, session] : ledger_.sessions()) {
            EXPECT_EQ(client.ask("DELETE", "/v1/sessions/" + id).status, 200);
            ledger_.remove_session(id, session.origin.slot);
        }
        SessionRecord bundled;
        bundled.id = "bundled-" + std::to_string(epochs_);
        bundled.origin.kind = Intent::Kind::Create;
        bundled.origin.slot = Slots::kBundled;
        EXPECT_EQ(make_bundled(client, bundled.id).status, 201);
        EXPECT_EQ(ledger_.add_session(bundled), "");
        SessionRecord grid;
        grid.id = "grid-" + std::to_string(epochs_++);
        grid.origin.kind = Intent::Kind::Create;
        grid.origin.slot = Slots::kStaying;
        grid.origin.body = grid_text(dice_, Slots::kPosts);
        EXPECT_EQ(client
                      .ask("PUT", "/v1/sessions/" + grid.id, {"Content-Type: application/json"},
                           grid.origin.body)
                      .status,
                  201);
        EXPECT_EQ(ledger_.add_session(grid), "");
    }

    /// Work until the kill.
    void work_and_kill() {
        std::atomic<bool> down{false};
        {
            std::list<std::jthread> threads;
            for (CrashClient& client : clients_)
                threads.emplace_back([&] { client.run(server_->port(), down); });
            pause(dice_.between(5, 350));
            Program& program = server_->program();
            EXPECT_TRUE(program.is_running()) << program.output();
            down = true;
            if (dice_.chance(0.15)) {  // while it stores what it has
                program.send_signal(SIGTERM);
                pause(dice_.between(0, 40));
            }
            program.send_signal(SIGKILL);
            program.wait();
        }
        EXPECT_EQ(complaints_in(server_->program().output()), "");
    }

    /// What was acknowledged is there, before anybody tries anything again.
    void expect_kept() {
        SteadyClient client(server_->port());
        std::set<std::string> leaving;
        for (const CrashClient& other : clients_)
            if (other.pending() && other.pending()->kind == Intent::Kind::RemoveSession)
                leaving.insert(other.pending()->session);
        for (const auto& [id, session] : ledger_.sessions()) {
            if (leaving.contains(id)) continue;
            const auto history = history_of(client, id);
            ASSERT_TRUE(history && !history->empty()) << id << " is not there";
            for (const auto& [version, intent] : session.changes) {
                const auto found = history->find(version);
                if (found == history->end()) {
                    ADD_FAILURE() << "version " << version << " of " << id << " is lost";
                } else {
                    EXPECT_EQ(found->second["change"], intent.history_kind) << id << version;
                }
            }
        }
    }

    /// What was not acknowledged is asked for until it is; then both servers have the same.
    void settle_and_compare() {
        for (CrashClient& client : clients_)
            EXPECT_TRUE(client.settle(server_->port())) << "a request is never acknowledged";
        const auto sessions = ledger_.sessions();
        EXPECT_EQ(model_.follow(sessions), "");
        SteadyClient client(server_->port());
        for (const auto& [id, session] : sessions)
            EXPECT_EQ(model_.difference(client, session), "");
        const Answer list = client.ask("GET", "/v1/sessions?limit=1000");
        std::set<std::string> told;
        const auto listed = nlohmann::json::parse(list.body, nullptr, false);
        for (const auto& session : listed.value("sessions", nlohmann::json()))
            told.insert(session["id"].get<std::string>());
        for (const auto& [id, session] : sessions)
            EXPECT_EQ(told.erase(id), 1) << id;
        EXPECT_EQ(told, std::set<std::string>()) << "sessions that nobody was told of";
        for (const std::string& fault : ledger_.take_faults())
            ADD_FAILURE() << fault;
    }

    const std::uint64_t seed_ = static_cast<std::uint64_t>(number_of("TINSMITH_SEED", 1));
    Dice dice_{seed_};
    ScratchDirectory folder_;
    Ledger ledger_;
    std::list<CrashClient> clients_;
    std::optional<ServerUnderTest> server_;
    Model model_;
    int epochs_ = 0;
    int false_starts_ = 0;
};

TEST_F(Crash, WhatWasAcknowledgedIsThereAfterAnyKill) {
    ASSERT_TRUE(model_.is_up());
    const int kills = number_of("TINSMITH_KILLS", kKillsOfTheShortForm);
    int done = 0;
    for (; done < kills && !HasFailure(); ++done) {
        const int i = done;
        ASSERT_NO_FATAL_FAILURE(start());
        ASSERT_NO_FATAL_FAILURE(expect_kept());
        // Else clients try again by themselves, and may be killed at that.
        if (i % 4 != 1) settle_and_compare();
        if (i % kKillsOfAnEpoch == 0) begin_epoch();
        work_and_kill();
        if (i % 50 == 49)
            std::cout << i + 1 << " kills, " << ledger_.acknowledged() << " acknowledged, "
                      << ledger_.replayed() << " replayed" << std::endl;
        if (HasFailure()) std::cout << "after " << i + 1 << " kills, seed " << seed_ << std::endl;
    }
    // Once after a crash, once after an orderly stop.
    for (int i = 0; i < 2 && !HasFailure(); ++i) {
        ASSERT_NO_FATAL_FAILURE(start());
        settle_and_compare();
        EXPECT_EQ(server_->stop(), "");
    }
    EXPECT_EQ(model_.stop().find("\"level\":\"error\""), std::string::npos);
    std::cout << done << " kills and " << false_starts_ << " at the start, "
              << ledger_.acknowledged() << " acknowledged, " << ledger_.replayed() << " replayed"
              << std::endl;
    EXPECT_GT(ledger_.acknowledged(), static_cast<std::size_t>(done));
    EXPECT_GT(ledger_.replayed(), 0U);
}

}  // namespace
}  // namespace tinsmith::e2e
