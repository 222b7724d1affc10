// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "tests/e2e/program.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {

/// What the process may hold beyond what it held, for requests that it refuses.
inline constexpr double kMostMebiForRefused = 20.0;

/// The longest that an honest client waits once an attack has ended.
inline constexpr int kMostSecondsToRecover = 10;

/// True for the long forms: more of everything, minutes instead of seconds.
bool is_long_form();

/// `tinsmith serve` under attack, with one session that an honest client asks about. What it holds
/// is taken at its peak (VmHWM), so that memory counts that was given back before anybody looked.
class Victim {
  public:
    explicit Victim(std::vector<std::string> arguments = {});

    int port() const { return server_->port(); }
    ServerUnderTest& server() { return *server_; }

    /// From here on memory counts. The constructor has called it once.
    void watch_memory();

    /// MiB beyond what was held when it was last watched, at the peak since then. Sanitizers and
    /// kernels that do not tell: 0.
    double growth() const;

    /// MiB beyond what was held when it was last watched, now.
    double growth_that_stays() const;

    /// What is not as it should be after an attack: the process, what it held, how long an honest
    /// client waits. Empty: all is well.
    std::string harm(double most_mebi = kMostMebiForRefused);

    /// The same, and the server ends in order with a clean log.
    std::string harm_at_the_end(double most_mebi = kMostMebiForRefused);

  private:
    double status_mebi(const std::string& name) const;

    std::unique_ptr<ServerUnderTest> server_;
    double held_ = 0;
};

/// Descriptors that this process and its children may open: at least so many, or as many as the
/// system allows. Returns the number.
std::size_t allow_descriptors(std::size_t wanted);

}  // namespace tinsmith::e2e
