// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/limits.hpp"

namespace tinsmith::server {

/// What one key may ask for, of the limits of all; nothing: as much as everyone.
struct KeyQuotas {
    std::optional<std::size_t> max_sessions{};
    std::optional<std::size_t> max_memory_bytes{};  ///< of its sessions, in memory or not
    std::optional<std::size_t> max_requests{};      ///< at the same time
    std::optional<double> max_requests_per_second{};
    std::optional<std::size_t> max_body_bytes{};
    std::optional<std::size_t> max_session_bytes{};  ///< of each of its sessions
    std::optional<std::size_t> max_vertices{};
    std::optional<std::size_t> max_triangles{};
    std::optional<std::size_t> max_polygon_vertices{};
    std::optional<std::uint64_t> max_crossings{};
    std::optional<double> max_edit_seconds{};
    std::optional<std::size_t> max_history{};        ///< of each of its sessions; 1 at least
    std::optional<std::size_t> max_history_bytes{};  ///< likewise
    std::optional<std::size_t> max_points{};
    std::optional<std::uint64_t> max_profile_crossings{};
    std::optional<std::size_t> max_queued_jobs{};  ///< of its jobs

    friend bool operator==(const KeyQuotas&, const KeyQuotas&) = default;
};

/// The limits of all, as far as a key's quotas allow. What the key has of its own, sessions and
/// memory and requests and jobs, is for others to count.
Limits within_quotas(Limits limits, const KeyQuotas& quotas);

/// Who asks: a key, or nobody in particular where the server asks for none.
///
/// Laws: what a key made is seen by that key alone. What was made where nobody had to show a key,
/// the demo terrain among it, was open to all who asked and stays so: every key sees it. Where no
/// keys are used everything is seen.
struct Asker {
    std::string id{};    ///< of the key, the same whatever it is called; empty: no keys are used
    std::string name{};  ///< for people
    KeyQuotas quotas{};

    /// `owner`: the id of the key that made it; empty: none did.
    bool may_see(std::string_view owner) const {
        return id.empty() || owner.empty() || owner == id;
    }
};

}  // namespace tinsmith::server
