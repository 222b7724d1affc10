// SPDX-License-Identifier: Apache-2.0
// Many clients, many sessions, every kind of request for a while: no answer but those that are
// promised, memory that stays, a clean log, and at the end the sessions outlive the process.
// TINSMITH_SOAK_SECONDS says how long, TINSMITH_PROGRAM names a binary with sanitizers.
#include <array>
#include <chrono>
#include <fstream>
#include <iostream>
#include <list>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/durability/ledger.hpp"
#include "tests/durability/soak_requests.hpp"
#include "tests/durability/steady_client.hpp"
#include "tests/e2e/program.hpp"

namespace tinsmith::e2e {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kClients = 32;
constexpr int kSessions = 16;
constexpr int kSecondsOfTheShortForm = 10;
/// A session is made anew after so many changes, so that what is there stays as large as it is.
constexpr std::uint64_t kLastVersion = 60;
/// From here on memory is to stay: caches are full, and what sanitizers hold back, too.
constexpr int kWarmUpSeconds = 120;
constexpr int kLongestAnswer = 120;  ///< seconds, with sanitizers on a machine that does more
constexpr double kMebi = 1024.0 * 1024.0;

int seconds_of_the_soak() {
    const char* text = std::getenv("TINSMITH_SOAK_SECONDS");
    return text == nullptr ? kSecondsOfTheShortForm : std::atoi(text);
}

std::string session_id(int number) {
    return "field-" + std::to_string(number);
}

/// MiB that the process holds.
double resident(pid_t pid) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/statm");
    double pages = 0;
    file >> pages >> pages;
    return pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / kMebi;
}

/// What was done, by kind and status.
class Tally {
  public:
    void add(const std::string& kind, const Answer& answer) {
        const std::lock_guard lock(mutex_);
        ++counts_[kind][answer.status];
        ++all_;
        static const std::set<int> kPromised{200, 201, 202, 204, 304, 404, 409, 410, 412, 422};
        if (kPromised.contains(answer.status) || (kind == "stopped" && answer.status == 503))
            return;
        if (surprises_.size() < 20)
            surprises_.push_back(kind + " is answered " + std::to_string(answer.status) + ": " +
                                 answer.body.substr(0, 300));
    }

    std::size_t all() const { return all_; }
    const std::vector<std::string>& surprises() const { return surprises_; }

    /// Those that never came to anything.
    std::set<std::string> never_fine() const {
        std::set<std::string> kinds;
        for (const auto& [kind, statuses] : counts_) {
            bool is_fine = false;
            for (const auto& [status, count] : statuses)
                is_fine = is_fine || status / 100 == 2;
            if (!is_fine) kinds.insert(kind);
        }
        return kinds;
    }

    void print() const {
        for (const auto& [kind, statuses] : counts_) {
            std::cout << "  " << kind << ":";
            for (const auto& [status, count] : statuses)
                std::cout << " " << status << " x" << count;
            std::cout << "\n";
        }
    }

  private:
    std::mutex mutex_;
    std::map<std::string, std::map<int, std::size_t>> counts_;
    std::vector<std::string> surprises_;
    std::size_t all_ = 0;
};

/// One client until the time is over.
class SoakClient {
  public:
    SoakClient(int port, int number, Tally& tally)
        : number_(number),
          dice_(static_cast<std::uint64_t>(number)),
          server_(port, kLongestAnswer),
          tally_(tally) {}

    void run(Clock::time_point until) {
        while (Clock::now() < until)
            step();
    }

  private:
    Answer ask(const SoakRequest& request) {
        const Answer answer =
            server_.ask(request.method, request.target, request.headers, request.body);
        tally_.add(request.kind, answer);
        return answer;
    }

    void step() {
        const int chosen = dice_.below(kSessions);
        SoakSession session{session_id(chosen), session_id((chosen + 1) % kSessions)};
        const Answer seen = ask({"session", "GET", "/v1/sessions/" + session.id});
        if (seen.status == 200) {
            session.tag = seen.header("etag");
            session.version = std::max<std::uint64_t>(version_of_tag(session.tag), 1);
        }
        if (seen.status == 404 || session.version > kLastVersion) return renew(session.id);
        SoakRequest request = soak_request(dice_, session);
        const bool has_key = request.method == "POST" && dice_.chance(0.2);
        if (has_key)
            request.headers.push_back("Idempotency-Key: s" + std::to_string(number_) + "-" +
                                      std::to_string(++keys_));
        const Answer answer = ask(request);
        if (has_key && dice_.chance(0.5)) ask(request);
        if (request.kind == "mesh unless known" && answer.status == 200)
            ask({"mesh, if it changed",
                 "GET",
                 request.target,
                 {"If-None-Match: " + answer.header("etag"), "Accept-Encoding: gzip"}});
        if (request.kind == "fork" && answer.status == 201)
            ask({"end of a fork", "DELETE", answer.header("location")});
        if (answer.status == 202) follow(answer.header("location"));
    }

    /// One of those who find that it is time makes it anew.
    void renew(const std::string& id) {
        const std::string target = "/v1/sessions/" + id;
        if (dice_.chance(0.3)) ask({"end of a session", "DELETE", target});
        ask({"new session",
             "PUT",
             target,
             {"Content-Type: application/json"},
             grid_text(dice_, kSoakPosts)});
    }

    void follow(const std::string& job) {
        if (dice_.chance(0.3)) {
            ask({"job stopped", "DELETE", job});
            return;
        }
        for (int i = 0; i < 100; ++i) {
            const Answer state = ask({"job state", "GET", job});
            const bool is_under_way = state.body.find("\"queued\"") != std::string::npos ||
                                      state.body.find("\"running\"") != std::string::npos;
            if (state.status != 200 || !is_under_way) break;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        ask({"job result", "GET", job + "/result"});
    }

    const int number_;
    Dice dice_;
    SteadyClient server_;
    Tally& tally_;
    int keys_ = 0;
};

class Soak : public testing::Test {
  protected:
    void start() {
        server_.emplace(std::vector<std::string>{
            "--data", folder_.file("data"), "--threads", std::to_string(kClients + 8),
            "--log-level", "warning", "--max-history", "30", "--mesh-cache", "16M",
            "--kept-answers", "8M", "--job-seconds", "5", "--job-bytes", "64M"});
        ASSERT_NE(server_->port(), 0) << server_->program().output();
    }

    std::map<std::string, std::string> meshes() {
        std::map<std::string, std::string> all;
        SteadyClient client(server_->port(), kLongestAnswer);
        for (int i = 0; i < kSessions; ++i) {
            const std::string target = "/v1/sessions/" + session_id(i) + "/mesh.json";
            const Answer answer = client.ask("GET", target);
            if (answer.status == 200)
                all[session_id(i)] = answer.header("etag") + "\n" + answer.body;
        }
        return all;
    }

    /// The mean of what is held in the middle and at the end, after the warm-up.
    static void expect_flat(const std::vector<double>& held) {
        const std::size_t part = held.size() / 4;
        double early = 0;
        double late = 0;
        for (std::size_t i = 0; i < part; ++i) {
            early += held[i] / static_cast<double>(part);
            late += held[held.size() - 1 - i] / static_cast<double>(part);
        }
        std::cout << "held after the warm-up: " << early << " MiB, at the end: " << late
                  << " MiB\n";
        EXPECT_LT(late, early * 1.1 + 32);
    }

    ScratchDirectory folder_;
    std::optional<ServerUnderTest> server_;
};

TEST_F(Soak, EveryKindOfRequestForAWhile) {
    const int seconds = seconds_of_the_soak();
    ASSERT_NO_FATAL_FAILURE(start());
    Tally tally;
    std::vector<double> held;
    {
        const auto begin = Clock::now();
        const auto end = begin + std::chrono::seconds(seconds);
        std::list<SoakClient> clients;
        std::list<std::jthread> threads;
        for (int i = 0; i < kClients; ++i) {
            SoakClient& client = clients.emplace_back(server_->port(), i, tally);
            threads.emplace_back([&client, end] { client.run(end); });
        }
        while (Clock::now() < end && server_->program().is_running()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(500));
            if (Clock::now() > begin + std::chrono::seconds(kWarmUpSeconds))
                held.push_back(resident(server_->program().pid()));
        }
    }
    ASSERT_TRUE(server_->program().is_running()) << server_->program().output();
    tally.print();
    std::cout << tally.all() << " requests in " << seconds << " s, "
              << resident(server_->program().pid()) << " MiB held" << std::endl;
    for (const std::string& surprise : tally.surprises())
        ADD_FAILURE() << surprise;
    EXPECT_EQ(tally.never_fine(), std::set<std::string>());
    EXPECT_GE(tally.all(), static_cast<std::size_t>(seconds)) << "it hardly answers";
    if (held.size() >= 100) expect_flat(held);

    const auto before = meshes();
    EXPECT_FALSE(before.empty());
    EXPECT_EQ(server_->stop(), "");
    ASSERT_NO_FATAL_FAILURE(start());
    EXPECT_TRUE(meshes() == before) << "sessions come back otherwise than they were";
    EXPECT_EQ(server_->stop(), "");
}

}  // namespace
}  // namespace tinsmith::e2e
