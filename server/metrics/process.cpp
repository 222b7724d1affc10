// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/process.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <system_error>

#include <sys/resource.h>
#include <unistd.h>

namespace tinsmith::server {

namespace {

/// The boot's time, in seconds since 1970: the line "btime N" of /proc/stat.
double boot_seconds() {
    std::ifstream stat("/proc/stat");
    for (std::string word; stat >> word;) {
        double seconds = 0.0;
        if (word == "btime" && stat >> seconds) return seconds;
    }
    return 0.0;
}

/// What follows the program's name in /proc/self/stat, which may hold anything. proc(5) numbers the
/// fields from 1; the first here is 3, the state.
std::istringstream own_stat() {
    std::ifstream file("/proc/self/stat");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::size_t end_of_name = text.rfind(')');
    return std::istringstream(end_of_name == text.npos ? "" : text.substr(end_of_name + 1));
}

std::uint64_t count_open_files() {
    std::error_code error;
    std::uint64_t count = 0;
    for (std::filesystem::directory_iterator file("/proc/self/fd", error), end;
         !error && file != end; file.increment(error))
        ++count;
    return count == 0 ? 0 : count - 1;  // but for the one that lists them
}

}  // namespace

ProcessFigures process_figures() {
    ProcessFigures found;
    const auto ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
    static const double kBoot = boot_seconds();
    std::istringstream stat = own_stat();
    std::string word;
    for (int field = 3; stat >> word; ++field) {
        if (field == 14 || field == 15) found.cpu_seconds += std::stod(word) / ticks;
        if (field == 22) found.start_seconds = kBoot + std::stod(word) / ticks;
        if (field == 23) found.virtual_bytes = std::stoull(word);
        if (field == 24) {
            found.resident_bytes =
                std::stoull(word) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
            break;
        }
    }
    rlimit files{};
    if (::getrlimit(RLIMIT_NOFILE, &files) == 0) found.max_files = files.rlim_cur;
    found.open_files = count_open_files();
    return found;
}

}  // namespace tinsmith::server
