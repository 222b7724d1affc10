// SPDX-License-Identifier: Apache-2.0
// What the service bears: edits of many clients, with the journal and without; one client's
// outlines beside what the disk takes for a sync; meshes that are encoded already.
// Usage: load_bench [CLIENTS [SECONDS]]; TMPDIR says on which disk.
#include <atomic>
#include <cstdlib>
#include <list>
#include <optional>
#include <thread>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/durability/bench_print.hpp"
#include "tests/durability/random_shapes.hpp"
#include "tests/durability/steady_client.hpp"
#include "tests/e2e/program.hpp"

namespace tinsmith::e2e {
namespace {

using nlohmann::json;

constexpr int kSessions = 16;
constexpr int kOutlines = 300;
const std::string kJson = "Content-Type: application/json";

/// Places for parcels: a lattice over the bundled terrain, on which none meets another.
struct Lattice {
    static constexpr double kMinX = 733000;
    static constexpr double kMinY = 6000 + 4000000;
    static constexpr int kColumns = 110;
    static constexpr int kRows = 115;
    static constexpr double kStep = 250;
    /// Neighbours in time are far apart in space.
    static constexpr int kStride = 7919;
};

/// The n-th parcel of a session: eight corners, 50 to 120 m across.
std::string parcel(Dice& dice, int number) {
    const int place = static_cast<int>(static_cast<long>(number) * Lattice::kStride %
                                       (Lattice::kColumns * Lattice::kRows));
    const double x = Lattice::kMinX + Lattice::kStep * (place % Lattice::kColumns);
    const double y = Lattice::kMinY + Lattice::kStep * (place / Lattice::kColumns);
    return polygon_text(ring_text(dice, x + dice.between(0, 100), y + dice.between(0, 100),
                                  dice.between(25, 60), 8));
}

/// The bundled lake's outline somewhere else.
std::string outline(Dice& dice, const json& lake) {
    json ring = lake;
    const double by_x = dice.between(-21000, 3500);
    const double by_y = dice.between(-18000, 8500);
    for (json& position : ring) {
        position[0] = position[0].get<double>() + by_x;
        position[1] = position[1].get<double>() + by_y;
    }
    return polygon_text(ring.dump());
}

std::string session_path(int number) {
    return "/v1/sessions/s" + std::to_string(number);
}

/// The server with its sessions.
class Field {
  public:
    Field(bool with_journal, int clients) {
        std::vector<std::string> arguments{"--log-level", "error", "--threads",
                                           std::to_string(clients + 4)};
        if (with_journal) {
            arguments.emplace_back("--data");
            arguments.push_back(folder_.file("data"));
        }
        server_.emplace(std::move(arguments));
        SteadyClient client(server_->port(), 60);
        const std::string terrain = content_of(TINSMITH_SOURCE_DIR "/tests/data/jacksboro.tif");
        const Answer made =
            client.ask("PUT", session_path(0), {"Content-Type: image/tiff"}, terrain);
        is_fine_ = made.status == 201;
        paths_.push_back(session_path(0));
        while (is_fine_ && paths_.size() < kSessions) {
            const Answer forked = client.ask("POST", session_path(0) + "/fork");
            is_fine_ = forked.status == 201;
            paths_.push_back(forked.header("location"));
        }
    }

    bool is_fine() const { return is_fine_; }
    int port() const { return server_->port(); }
    int pid() { return server_->program().pid(); }
    std::string data() const { return folder_.file("data"); }
    const std::string& path(int number) const {
        return paths_[static_cast<std::size_t>(number % kSessions)];
    }

    /// A figure of /metrics by the beginning of its line.
    double figure(const std::string& name) const {
        const std::string text = ask(server_->port(), "GET", "/metrics").body;
        const std::size_t at = text.find("\n" + name + " ");
        return at == std::string::npos ? 0 : std::atof(text.c_str() + at + name.size() + 2);
    }

  private:
    ScratchDirectory folder_;
    std::optional<ServerUnderTest> server_;
    std::vector<std::string> paths_;
    bool is_fine_ = false;
};

struct Run {
    double a_second = 0;
    std::vector<double> milliseconds;
    std::size_t failed = 0;
};

/// Clients that each do one thing after the other for so long.
template <typename Work>
Run run_clients(int port, int clients, int seconds, Work work) {
    std::vector<Run> runs(static_cast<std::size_t>(clients));
    const auto begin = BenchClock::now();
    const auto end = begin + std::chrono::seconds(seconds);
    {
        std::list<std::jthread> threads;
        for (int i = 0; i < clients; ++i) {
            threads.emplace_back([&, i] {
                SteadyClient client(port, 60);
                Dice dice(static_cast<std::uint64_t>(i) + 1);
                Run& run = runs[static_cast<std::size_t>(i)];
                while (BenchClock::now() < end) {
                    const auto start = BenchClock::now();
                    const int status = work(client, dice, i);
                    run.milliseconds.push_back(milliseconds_since(start));
                    if (status != 200) ++run.failed;
                }
            });
        }
    }
    const double took = milliseconds_since(begin) / 1e3;
    Run all;
    for (const Run& run : runs) {
        all.failed += run.failed;
        all.milliseconds.insert(all.milliseconds.end(), run.milliseconds.begin(),
                                run.milliseconds.end());
    }
    all.a_second = static_cast<double>(all.milliseconds.size()) / took;
    return all;
}

void print_row(const char* what, const Run& run) {
    std::printf("| %-44s | %8.0f | %8.3f | %8.3f | %6zu |\n", what, run.a_second,
                quantile(run.milliseconds, 0.5), quantile(run.milliseconds, 0.99), run.failed);
    std::fflush(stdout);
}

Run edit_parcels(const Field& field, int clients, int seconds) {
    std::atomic<int> number{0};
    return run_clients(field.port(), clients, seconds, [&](SteadyClient& client, Dice& dice, int) {
        const int mine = number++;
        return client
            .ask("POST", field.path(mine) + "/polygons", {kJson}, parcel(dice, mine / kSessions))
            .status;
    });
}

/// One client's outlines, and after each a page that is written to the same disk and synced.
void outlines_beside_the_disk(const Field& field, Run& edits, Run& syncs) {
    const json lake = json::parse(content_of(TINSMITH_SOURCE_DIR "/tests/data/lake.geojson"));
    const json& ring = lake["features"][0]["geometry"]["coordinates"][0];
    const std::string bare = field.data() + ".bare";
    const int file = ::open(bare.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
    const std::string page(4096, 'x');
    SteadyClient client(field.port(), 60);
    Dice dice(7);
    for (int i = 0; i < kOutlines; ++i) {
        const std::string body = outline(dice, ring);
        auto start = BenchClock::now();
        const int status = client.ask("POST", field.path(i) + "/polygons", {kJson}, body).status;
        edits.milliseconds.push_back(milliseconds_since(start));
        if (status != 200) ++edits.failed;
        start = BenchClock::now();
        const bool is_written =
            ::write(file, page.data(), page.size()) == static_cast<ssize_t>(page.size()) &&
            ::fdatasync(file) == 0;
        syncs.milliseconds.push_back(milliseconds_since(start));
        if (!is_written) ++syncs.failed;
    }
    ::close(file);
    for (Run* run : {&edits, &syncs}) {
        double sum = 0;
        for (const double one : run->milliseconds)
            sum += one;
        run->a_second = 1e3 * kOutlines / sum;
    }
}

int bench(int clients, int seconds) {
    print_machine();
    std::printf("%d sessions of the bundled terrain, %d clients, %d s each\n\n", kSessions, clients,
                seconds);
    std::printf("| %-44s | %8s | %8s | %8s | %6s |\n", "", "a second", "p50 ms", "p99 ms",
                "failed");
    std::printf("|---|---|---|---|---|\n");
    Field field(true, clients);
    if (!field.is_fine()) return 1;
    Run edits;
    Run syncs;
    outlines_beside_the_disk(field, edits, syncs);
    print_row("outline of 90 segments, one client", edits);
    print_row("write of 4 KiB and fdatasync, beside it", syncs);
    const double commits = field.figure("tinsmith_journal_commits_total");
    const double entries = field.figure("tinsmith_journal_entries_total");
    print_row("parcel of 8 corners", edit_parcels(field, clients, seconds));
    const double more_commits = field.figure("tinsmith_journal_commits_total") - commits;
    const double more_entries = field.figure("tinsmith_journal_entries_total") - entries;
    for (int i = 0; i < kSessions; ++i)
        ask(field.port(), "GET", field.path(i) + "/mesh.glb");
    std::atomic<std::size_t> bytes{0};
    const Run meshes =
        run_clients(field.port(), clients, seconds, [&](SteadyClient& client, Dice& dice, int) {
            const Answer answer =
                client.ask("GET", field.path(dice.below(kSessions)) + "/mesh.glb");
            bytes += answer.body.size();
            return answer.status;
        });
    print_row("mesh.glb, encoded already", meshes);
    {
        const Field memory(false, clients);
        if (!memory.is_fine()) return 1;
        print_row("parcel of 8 corners, no --data", edit_parcels(memory, clients, seconds));
    }
    std::printf("\n%.1f edits a commit; %.0f commits a second; a mesh is %.0f bytes\n",
                more_entries / std::max(more_commits, 1.0), more_commits / seconds,
                static_cast<double>(bytes) /
                    static_cast<double>(std::max<std::size_t>(meshes.milliseconds.size(), 1)));
    return 0;
}

}  // namespace
}  // namespace tinsmith::e2e

int main(int argc, char** argv) {
    const int clients = argc > 1 ? std::atoi(argv[1]) : 32;
    const int seconds = argc > 2 ? std::atoi(argv[2]) : 10;
    return tinsmith::e2e::bench(std::max(clients, 1), std::max(seconds, 1));
}
