// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>

namespace tinsmith::server {

/// How fast a client has to send its body and take its answer: who only keeps the connection alive
/// would keep its thread, too.
class Pace {
  public:
    using Clock = std::chrono::steady_clock;

    /// Everybody has `patience`, and more who moves at least so many bytes a second.
    Pace(std::chrono::seconds patience, std::size_t bytes_a_second)
        : patience_(patience), bytes_a_second_(static_cast<double>(bytes_a_second)) {}

    bool is_too_slow(Clock::time_point start, std::size_t bytes) const {
        const std::chrono::duration<double> fair{static_cast<double>(bytes) / bytes_a_second_};
        return Clock::now() - start > patience_ + fair;
    }

  private:
    std::chrono::seconds patience_;
    double bytes_a_second_;
};

}  // namespace tinsmith::server
