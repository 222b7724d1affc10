// SPDX-License-Identifier: Apache-2.0
#include "server/keys/asker.hpp"

#include <algorithm>

namespace tinsmith::server {

Limits within_quotas(Limits limits, const KeyQuotas& quotas) {
    const auto tighten = [](auto& limit, const auto& quota) {
        if (quota) limit = std::min(limit, *quota);
    };
    tighten(limits.max_body_bytes, quotas.max_body_bytes);
    tighten(limits.max_session_bytes, quotas.max_session_bytes);
    tighten(limits.max_vertices, quotas.max_vertices);
    tighten(limits.max_triangles, quotas.max_triangles);
    tighten(limits.max_polygon_vertices, quotas.max_polygon_vertices);
    tighten(limits.max_crossings, quotas.max_crossings);
    tighten(limits.max_edit_seconds, quotas.max_edit_seconds);
    tighten(limits.max_history, quotas.max_history);
    tighten(limits.max_history_bytes, quotas.max_history_bytes);
    tighten(limits.max_points, quotas.max_points);
    tighten(limits.max_profile_crossings, quotas.max_profile_crossings);
    return limits;
}

}  // namespace tinsmith::server
