// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "api/formats/read_limits.hpp"
#include "server/limits.hpp"
#include "server/session_store.hpp"

namespace tinsmith::server {

/// What the handlers of one process share.
struct Services {
    explicit Services(const Limits& the_limits) : limits(the_limits), sessions(the_limits) {}

    api::ReadLimits read_limits() const {
        api::ReadLimits read;
        read.max_vertices = limits.max_vertices;
        read.max_triangles = limits.max_triangles;
        return read;
    }

    const Limits limits;
    SessionStore sessions;
    std::atomic<bool> stopping{false};  ///< edits under way give up when it turns true
};

}  // namespace tinsmith::server
