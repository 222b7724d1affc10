// SPDX-License-Identifier: Apache-2.0
#include "tests/attack/victim.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <sys/resource.h>

#include "tests/durability/random_shapes.hpp"

namespace tinsmith::e2e {

namespace {

using Clock = std::chrono::steady_clock;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsMemoryOurs = false;  // most of it is the sanitizer's
#else
constexpr bool kIsMemoryOurs = true;
#endif

constexpr int kPosts = 20;
const std::string kHonest = "/v1/sessions/honest";

std::vector<std::string> with_quiet_log(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--log-level", "error"});
    return arguments;
}

}  // namespace

bool is_long_form() {
    return std::getenv("TINSMITH_ATTACK_LONG") != nullptr;
}

Victim::Victim(std::vector<std::string> arguments)
    : server_(std::make_unique<ServerUnderTest>(with_quiet_log(std::move(arguments)))) {
    if (port() == 0) return;
    Dice dice(1);
    ask(port(), "PUT", kHonest, {"Content-Type: application/json"}, grid_text(dice, kPosts));
    watch_memory();
}

double Victim::status_mebi(const std::string& name) const {
    std::ifstream file("/proc/" + std::to_string(server_->program().pid()) + "/status");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with(name + ":")) return std::atof(line.c_str() + name.size() + 1) / 1024;
    }
    return 0;
}

void Victim::watch_memory() {
    // 5: the peak begins anew (proc(5)).
    std::ofstream("/proc/" + std::to_string(server_->program().pid()) + "/clear_refs") << "5";
    held_ = status_mebi("VmRSS");
}

double Victim::growth() const {
    if (!kIsMemoryOurs) return 0;
    return std::max(status_mebi("VmHWM"), status_mebi("VmRSS")) - held_;
}

double Victim::growth_that_stays() const {
    return kIsMemoryOurs ? status_mebi("VmRSS") - held_ : 0;
}

std::string Victim::harm(double most_mebi) {
    if (port() == 0) return "it did not come up: " + server_->program().output();
    const double grown = growth();
    std::string harm;
    if (grown > most_mebi) harm += "it held " + std::to_string(grown) + " MiB more\n";
    const auto start = Clock::now();
    Connection connection(port(), kMostSecondsToRecover);
    connection.send(request_text("GET", kHonest + "/elevation?x=4&y=4"));
    const Answer answer = connection.read();
    const double waited = std::chrono::duration<double>(Clock::now() - start).count();
    if (answer.status != 200 || waited > kMostSecondsToRecover) {
        harm += "an honest client waited " + std::to_string(waited) + " s for status " +
                std::to_string(answer.status) + "\n";
    }
    if (!server_->program().is_running()) {
        harm += "the process has ended: " + server_->program().output();
    }
    return harm;
}

std::string Victim::harm_at_the_end(double most_mebi) {
    std::string all = harm(most_mebi);
    return all += server_->stop();
}

std::size_t allow_descriptors(std::size_t wanted) {
    rlimit limit{};
    ::getrlimit(RLIMIT_NOFILE, &limit);
    if (limit.rlim_cur >= wanted) return limit.rlim_cur;
    // Root may raise the hard limit too.
    const rlimit raised{wanted, std::max<rlim_t>(limit.rlim_max, wanted)};
    if (::setrlimit(RLIMIT_NOFILE, &raised) == 0) return wanted;
    limit.rlim_cur = limit.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &limit);
    return limit.rlim_cur;
}

}  // namespace tinsmith::e2e
