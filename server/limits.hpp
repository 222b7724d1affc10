// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace tinsmith::server {

/// What one service may be asked for. Every refusal names the limit it met by these names.
struct Limits {
    std::size_t max_body_bytes = std::size_t{256} << 20;
    std::size_t max_sessions = 64;
    std::size_t max_memory_bytes = std::size_t{8} << 30;     ///< of all meshes together
    std::size_t max_session_bytes = std::size_t{4} << 30;    ///< of one session
    std::size_t max_vertices = 10'000'000;                   ///< of one session
    std::size_t max_triangles = 20'000'000;                  ///< of one session
    std::size_t max_polygon_vertices = 1'000'000;            ///< of one request
    std::size_t max_history = 1000;                          ///< operations that a session keeps
    std::size_t max_history_bytes = std::size_t{256} << 20;  ///< that they hold, of one session
    std::uint64_t max_crossings = 50'000'000;                ///< of one request
    double max_edit_seconds = 60.0;                          ///< of one request
    std::size_t max_requests = 32;                           ///< at the same time, without jobs
    std::size_t max_points = 100'000;                        ///< of one question for elevations
    std::uint64_t max_profile_crossings = 1'000'000;   ///< of one profile: its answer's points
    std::size_t job_threads = 2;                       ///< requests done as jobs at a time
    std::size_t max_jobs = 1000;                       ///< in any state
    std::size_t max_queued_jobs = 64;                  ///< that wait for a thread
    std::size_t job_bytes = std::size_t{256} << 20;    ///< their requests and answers
    std::uint64_t job_seconds = 3600;                  ///< for which answers are kept
    std::size_t mesh_cache = std::size_t{256} << 20;   ///< bytes of encoded meshes
    std::size_t kept_answers = std::size_t{64} << 20;  ///< bytes, for retries by key
    std::uint64_t session_ttl = 0;  ///< seconds for which one lives that nobody asks for; 0: ever
};

/// Shape of a request before its body is read; see `check_request`.
inline constexpr std::size_t kMaxPathBytes = 512;
inline constexpr std::size_t kMaxHeaders = 90;
inline constexpr std::size_t kMaxQueryParameters = 64;

}  // namespace tinsmith::server
