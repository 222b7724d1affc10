// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>

#include "server/http_message.hpp"

namespace tinsmith::server {

/// How many requests there are at the same time: judges them by their heads, so that what is
/// refused has no body in memory.
///
/// Laws: at most so many requests under /v1 hold a pass, from their head until they and their
/// copies are gone; one more is told to come again. Whether the server lives, its figures, its page
/// and its description are told however many there are, and so is OPTIONS.
/// From any thread.
class Turnstile {
  public:
    /// It outlives the requests.
    explicit Turnstile(std::size_t most) : most_(most) {}

    /// What is answered instead; nothing: go on, the request holds its pass.
    std::optional<Response> admit(Request& request);

  private:
    class Pass;

    Response refuse_for_now(const Request& request) const;

    const std::size_t most_;
    std::atomic<std::size_t> inside_{0};
};

}  // namespace tinsmith::server
