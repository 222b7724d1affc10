// SPDX-License-Identifier: Apache-2.0
// How long a large session takes to be there again after kill -9: a million triangles, a thousand
// changes. Usage: recovery_bench [POSTS [CHANGES [RUNS]]]; TMPDIR says on which disk.
#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include <nlohmann/json.hpp>

#include "tests/durability/bench_print.hpp"
#include "tests/durability/random_shapes.hpp"
#include "tests/durability/steady_client.hpp"
#include "tests/e2e/program.hpp"

namespace tinsmith::e2e {
namespace {

const std::string kJson = "Content-Type: application/json";
const std::string kSession = "/v1/sessions/large";

/// Hills on a grid of posts ten units apart, as an ESRI ASCII grid.
std::string hills(int posts) {
    std::string text = "ncols " + std::to_string(posts) + "\nnrows " + std::to_string(posts) +
                       "\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
    Dice dice(3);
    std::array<char, 16> number{};
    for (int y = 0; y < posts; ++y) {
        for (int x = 0; x < posts; ++x) {
            const double height = 300 + 40 * std::sin(x * 0.013) * std::cos(y * 0.017) +
                                  8 * std::sin(x * 0.11 + y * 0.07) + dice.between(-0.2, 0.2);
            std::snprintf(number.data(), number.size(), "%.3f ", height);
            text += number.data();
        }
        text += '\n';
    }
    return text;
}

class Recovery {
  public:
    /// Milliseconds from the start of the process to its first 200 at /readyz.
    double start() {
        const auto begin = BenchClock::now();
        server_.emplace(std::vector<std::string>{"--data", folder_.file("data")});
        return milliseconds_since(begin);
    }

    bool is_up() const { return server_ && server_->port() != 0; }

    bool make(int posts, int changes) {
        SteadyClient client(server_->port(), 120);
        const Answer made = client.ask("PUT", kSession, {"Content-Type: text/plain"}, hills(posts));
        if (made.status != 201) {
            std::fprintf(stderr, "%s\n", made.body.c_str());
            return false;
        }
        Dice dice(4);
        const double side = 10.0 * (posts - 1);
        for (int i = 0; i < changes; ++i) {
            // As a parcel, a pond, and now and then a lake.
            const int corners = i % 50 == 0 ? 300 : i % 5 == 0 ? 90 : 8;
            const double radius = i % 50 == 0 ? 800 : i % 5 == 0 ? 200 : 60;
            const std::string body =
                polygon_text(ring_text(dice, dice.between(0.15, 0.85) * side,
                                       dice.between(0.15, 0.85) * side, radius, corners));
            const Answer answer =
                client.ask("POST", kSession + "/polygons",
                           {kJson, "Idempotency-Key: k" + std::to_string(i)}, body);
            if (answer.status != 200) {
                std::fprintf(stderr, "%s\n", answer.body.c_str());
                return false;
            }
        }
        return true;
    }

    void kill() {
        server_->program().send_signal(SIGKILL);
        server_->program().wait();
    }

    /// What tells of all of the session: its tag and its mesh in doubles.
    std::pair<std::string, std::string> content() const {
        SteadyClient client(server_->port(), 120);
        const Answer answer = client.ask("GET", kSession + "/mesh?since=0",
                                         {"Accept: application/vnd.tinsmith.delta"});
        return {answer.header("etag"), answer.body};
    }

    std::string facts() const { return ask(server_->port(), "GET", kSession).body; }

    std::uintmax_t stored_bytes() const {
        std::uintmax_t sum = 0;
        for (const auto& file : std::filesystem::directory_iterator(folder_.file("data")))
            sum += file.file_size();
        return sum;
    }

  private:
    ScratchDirectory folder_;
    std::optional<ServerUnderTest> server_;
};

int bench(int posts, int changes, int runs) {
    print_machine();
    Recovery recovery;
    recovery.start();
    if (!recovery.is_up()) return 1;
    const auto begin = BenchClock::now();
    if (!recovery.make(posts, changes)) return 1;
    const auto facts = nlohmann::json::parse(recovery.facts());
    std::printf("%zu triangles after %d changes, made in %.1f s\n\n",
                facts["triangles"].get<std::size_t>(), changes, milliseconds_since(begin) / 1e3);
    const auto before = recovery.content();
    std::printf("| start | ready after ms | stored MiB |\n|---|---|---|\n");
    for (int i = 0; i < runs; ++i) {
        recovery.kill();
        const double stored = static_cast<double>(recovery.stored_bytes()) / 1048576.0;
        const double took = recovery.start();
        if (!recovery.is_up()) return 1;
        std::printf("| %d | %.0f | %.1f |\n", i + 1, took, stored);
        std::fflush(stdout);
        if (recovery.content() != before) {
            std::printf("the session is not what it was\n");
            return 1;
        }
    }
    std::printf("\nafter each the same version and the same %.1f MiB of mesh\n",
                static_cast<double>(before.second.size()) / 1048576.0);
    return 0;
}

}  // namespace
}  // namespace tinsmith::e2e

int main(int argc, char** argv) {
    const int posts = argc > 1 ? std::atoi(argv[1]) : 708;
    const int changes = argc > 2 ? std::atoi(argv[2]) : 1000;
    const int runs = argc > 3 ? std::atoi(argv[3]) : 5;
    return tinsmith::e2e::bench(std::max(posts, 20), std::max(changes, 1), std::max(runs, 1));
}
