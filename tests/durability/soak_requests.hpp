// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/durability/random_shapes.hpp"

namespace tinsmith::e2e {

/// A request, and what it is called in the count of what was done.
struct SoakRequest {
    std::string kind;
    std::string method;
    std::string target;
    std::vector<std::string> headers{};
    std::string body{};
};

/// What a client knows of the session it asks about.
struct SoakSession {
    std::string id;
    std::string other;  ///< another session
    std::uint64_t version = 1;
    std::string tag{};  ///< its ETag; may be empty
};

inline constexpr int kSoakPosts = 20;  ///< along a side of each session's grid

/// Every kind of request, again and again in an order that the dice give. Mostly changes and
/// meshes.
SoakRequest soak_request(Dice& dice, const SoakSession& session);

}  // namespace tinsmith::e2e
