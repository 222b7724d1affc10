// SPDX-License-Identifier: Apache-2.0
// More sessions than memory is given for: they leave and come back all the time, and each is always
// what its last change made of it, to the byte, with its history and what undo goes back to.
#include <chrono>
#include <list>
#include <map>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/durability/ledger.hpp"
#include "tests/durability/steady_client.hpp"
#include "tests/e2e/program.hpp"

namespace tinsmith::e2e {
namespace {

using nlohmann::json;

constexpr int kClients = 3;
constexpr int kSessionsOfEach = 6;
constexpr int kSteps = 120;
constexpr int kPosts = 50;
constexpr std::size_t kBudget = std::size_t{3} << 20;
const std::string kJson = "Content-Type: application/json";

/// One client with sessions of its own, which knows what they are to be.
class Owner {
  public:
    Owner(int port, int number)
        : number_(number), dice_(static_cast<std::uint64_t>(number) + 1), server_(port) {}

    void run() {
        for (int i = 0; i < kSessionsOfEach; ++i) {
            EXPECT_EQ(ask("PUT", path(i), grid_text(dice_, kPosts)).status, 201);
            meshes_[i] = {mesh(i)};
        }
        for (int i = 0; i < kSteps; ++i)
            step(dice_.below(kSessionsOfEach));
    }

    void expect_all() {
        for (int i = 0; i < kSessionsOfEach; ++i)
            expect_known(i);
    }

  private:
    std::string path(int session) const {
        return "/v1/sessions/c" + std::to_string(number_) + "-" + std::to_string(session);
    }

    /// Others may hold all the memory for the moment.
    Answer ask(const std::string& method, const std::string& target, const std::string& body = {}) {
        Answer answer;
        for (int i = 0; i < 2000; ++i) {
            answer = server_.ask(method, target, {kJson}, body);
            if (answer.status != 507) break;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return answer;
    }

    std::string mesh(int session) {
        const Answer answer = ask("GET", path(session) + "/mesh.json");
        EXPECT_EQ(answer.status, 200) << answer.body;
        return answer.body;
    }

    void expect_known(int session) {
        const auto& known = meshes_[session];
        const Answer seen = ask("GET", path(session));
        EXPECT_EQ(version_of_tag(seen.header("etag")), versions_[session] + 1) << seen.body;
        EXPECT_TRUE(mesh(session) == known.back()) << path(session) << " came back otherwise";
    }

    /// A change, or the newest one taken back, of a session that may have left in the meantime.
    void step(int session) {
        expect_known(session);
        auto& known = meshes_[session];
        const bool goes_back = known.size() > 1 && dice_.chance(0.3);
        const std::string ring =
            ring_text(dice_, dice_.between(8, kPosts - 8), dice_.between(8, kPosts - 8), 5, 8);
        const Answer answer = goes_back
                                  ? ask("POST", path(session) + "/undo")
                                  : ask("POST", path(session) + "/polygons", polygon_text(ring));
        ASSERT_EQ(answer.status, 200) << answer.body;
        ++versions_[session];
        if (goes_back) {
            known.pop_back();
            EXPECT_TRUE(mesh(session) == known.back()) << "undo goes back to something else";
        } else {
            known.push_back(mesh(session));
        }
    }

    const int number_;
    Dice dice_;
    SteadyClient server_;
    std::map<int, std::vector<std::string>> meshes_;  ///< after the changes that are not undone
    std::map<int, std::uint64_t> versions_;           ///< changes made
};

TEST(ColdSessions, LeaveMemoryAndComeBackAsTheyWere) {
    const ScratchDirectory folder;
    ServerUnderTest server({"--data", folder.file("data"), "--max-memory-bytes",
                            std::to_string(kBudget), "--mesh-cache", "0", "--log-level", "error"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    std::list<Owner> owners;
    {
        std::list<std::jthread> threads;
        for (int i = 0; i < kClients; ++i) {
            Owner& owner = owners.emplace_back(server.port(), i);
            threads.emplace_back([&owner] { owner.run(); });
        }
    }
    for (Owner& owner : owners)
        owner.expect_all();
    const auto list = json::parse(ask(server.port(), "GET", "/v1/sessions").body);
    std::size_t bytes = 0;
    for (const auto& session : list["sessions"])
        bytes += session["memory_bytes"].get<std::size_t>();
    EXPECT_GT(bytes, kBudget) << "all of them fit, nothing was tried";
    EXPECT_EQ(server.stop(), "");
}

}  // namespace
}  // namespace tinsmith::e2e
