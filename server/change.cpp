// SPDX-License-Identifier: Apache-2.0
#include "server/change.hpp"

#include <algorithm>
#include <utility>

namespace tinsmith::server {

namespace {

/// About what another triangle takes, with its share of vertices and of what takes it back.
constexpr std::size_t kBytesOfTriangle = 160;

std::size_t room(std::size_t now, std::size_t most) {
    return most - std::min(most, now);
}

}  // namespace

RunLimits tightened(RunLimits limits, const SessionSize& now, const SessionSize& most) {
    const std::uint64_t by_count = room(now.triangles, most.triangles);
    const std::uint64_t by_memory = room(now.bytes, most.bytes) / kBytesOfTriangle;
    limits.is_bound_by_memory = by_memory < std::min(by_count, limits.max_new_triangles);
    limits.max_new_triangles = std::min({limits.max_new_triangles, by_count, by_memory});
    return limits;
}

core::Errors named_by(const RunLimits& limits, core::Errors errors) {
    if (!limits.is_bound_by_memory) return errors;
    for (core::Error& error : errors) {
        if (error.code != core::ErrorCode::TriangleBudget) continue;
        error.code = core::ErrorCode::MemoryBudget;
        error.detail =
            "the session would hold more memory than allowed; send less, or divide the terrain";
    }
    return errors;
}

}  // namespace tinsmith::server
