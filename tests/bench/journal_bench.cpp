// SPDX-License-Identifier: Apache-2.0
// Usage: journal_bench [FOLDER [SECONDS]]
// Appends a second, and how long one takes, with 1, 16 and 64 threads, each with a session of its
// own; beside them a bare loop that writes the same bytes to a file and syncs it. And how long
// appends take while a large snapshot is written.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "server/store/journal.hpp"

namespace tinsmith::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kBodyBytes = 600;
constexpr std::size_t kSnapshotBytes = std::size_t{200} << 20;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void print(const std::string& what, std::vector<double> times, double seconds, double a_commit) {
    std::sort(times.begin(), times.end());
    const auto at = [&times](double part) {
        const auto last = static_cast<double>(times.size() - 1);
        return times[static_cast<std::size_t>(part * last)];
    };
    std::printf("| %s | %.0f | %.3f | %.3f | %.3f | %.1f |\n", what.c_str(),
                static_cast<double>(times.size()) / seconds, at(0.5), at(0.99), at(1.0), a_commit);
    std::fflush(stdout);
}

JournalEntry entry(const std::string& birth, std::uint64_t version) {
    return {birth,
            version,
            1,
            std::string(kBodyBytes, static_cast<char>('a' + version % 26)),
            std::string(32, 'd'),
            "",
            "",
            std::string(60, 'v')};
}

void stop(const std::string& why) {
    std::fprintf(stderr, "journal_bench: %s\n", why.c_str());
    std::exit(1);
}

/// As many bytes as a lone commit of the journal writes: its log takes a page and 24 bytes.
void bare_loop(const std::filesystem::path& folder, double seconds) {
    constexpr off_t kLog = off_t{8} << 20;
    const std::string bytes(4096 + 24, 'x');
    const std::filesystem::path path = folder / "bare";
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (file < 0) stop(path.string() + " cannot be written");
    // Over the same few megabytes again and again, as the log is: a file that grows costs more.
    const std::string old(kLog, 'o');
    if (::pwrite(file, old.data(), old.size(), 0) < 0 || ::fsync(file) != 0)
        stop(path.string() + " cannot be written");
    std::vector<double> times;
    const auto start = Clock::now();
    for (off_t offset = 0; ms_since(start) < seconds * 1000;) {
        const auto before = Clock::now();
        if (::pwrite(file, bytes.data(), bytes.size(), offset) < 0 || ::fdatasync(file) != 0)
            stop(path.string() + " cannot be synced");
        times.push_back(ms_since(before));
        offset = (offset + static_cast<off_t>(bytes.size())) % (kLog - 8192);
    }
    ::close(file);
    print("bare write and fdatasync", std::move(times), seconds, 1);
}

/// Appends from so many threads until told to stop; how long each took.
class Appenders {
  public:
    Appenders(Journal& journal, std::size_t threads, const std::string& prefix) : times_(threads) {
        for (std::size_t i = 0; i < threads; ++i) {
            const std::string birth = prefix + std::to_string(i);
            if (const auto fault = journal.create({birth, birth, "", "", "", 0}, {}, "mesh"))
                stop(fault->text);
            threads_.emplace_back([this, &journal, birth, i] {
                for (std::uint64_t version = 1; !is_done_; ++version) {
                    const auto before = Clock::now();
                    if (const auto fault = journal.append(entry(birth, version))) stop(fault->text);
                    times_[i].push_back(ms_since(before));
                }
            });
        }
    }
    std::vector<double> finish() {
        is_done_ = true;
        std::vector<double> all;
        for (std::size_t i = 0; i < threads_.size(); ++i) {
            threads_[i].join();
            all.insert(all.end(), times_[i].begin(), times_[i].end());
        }
        return all;
    }

  private:
    std::atomic<bool> is_done_{false};
    std::vector<std::vector<double>> times_;
    std::vector<std::thread> threads_;
};

double entries_a_commit(const JournalFigures& before, const JournalFigures& after) {
    return static_cast<double>(after.entries - before.entries) /
           static_cast<double>(std::max<std::uint64_t>(1, after.commits - before.commits));
}

void appends(Journal& journal, std::size_t threads, double seconds) {
    const std::string name = std::to_string(threads) + (threads == 1 ? " thread" : " threads");
    Appenders appenders(journal, threads, name);
    const JournalFigures before = journal.figures();
    const auto start = Clock::now();
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    std::vector<double> times = appenders.finish();
    const double took = ms_since(start) / 1000;
    print(name, std::move(times), took, entries_a_commit(before, journal.figures()));
}

void beside_a_snapshot(Journal& journal) {
    const std::string mesh(kSnapshotBytes, 'm');
    Appenders appenders(journal, 16, "beside");
    const JournalFigures before = journal.figures();
    const auto start = Clock::now();
    if (const auto fault = journal.create({"large", "large", "", "", "", 0}, {}, mesh))
        stop(fault->text);
    const double took = ms_since(start) / 1000;
    print("16 threads beside a snapshot of 200 MiB", appenders.finish(), took,
          entries_a_commit(before, journal.figures()));
    const auto read_start = Clock::now();
    if (std::holds_alternative<JournalFault>(journal.read("large"))) stop("it cannot be read");
    std::printf("\nThat snapshot took %.2f s to write and %.2f s to read.\n", took,
                ms_since(read_start) / 1000);
}

int run(const std::filesystem::path& parent, double seconds) {
    const std::filesystem::path folder = parent / ("journal_bench." + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    std::printf("| | a second | p50 ms | p99 ms | most ms | entries a commit |\n");
    std::printf("|---|--:|--:|--:|--:|--:|\n");
    bare_loop(folder, seconds);
    {
        JournalOptions options;
        options.folder = folder / "data";
        auto opened = Journal::open(options);
        if (const auto* why = std::get_if<std::string>(&opened)) stop(*why);
        Journal& journal = *std::get<0>(opened);
        for (const std::size_t threads : {1U, 16U, 64U})
            appends(journal, threads, seconds);
        bare_loop(folder, seconds);
        beside_a_snapshot(journal);
    }
    std::filesystem::remove_all(folder);
    return 0;
}

}  // namespace
}  // namespace tinsmith::server

int main(int count, char** arguments) {
    const std::filesystem::path folder =
        count > 1 ? std::filesystem::path(arguments[1]) : std::filesystem::temp_directory_path();
    return tinsmith::server::run(folder, count > 2 ? std::strtod(arguments[2], nullptr) : 5.0);
}
