// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/components.hpp"

namespace tinsmith::core {

std::vector<TriangleId> find_components(const Tin& tin) {
    std::vector<TriangleId> found;
    std::vector<bool> seen(tin.triangle_count(), false);
    std::vector<TriangleId> pending;
    for (std::uint32_t first = 0; first < tin.triangle_count(); ++first) {
        if (seen[first]) continue;
        found.push_back({first});
        seen[first] = true;
        pending.push_back({first});
        while (!pending.empty()) {
            const TriangleId t = pending.back();
            pending.pop_back();
            for (const Side twin : tin.triangle(t).twins) {
                if (!twin.valid() || seen[twin.triangle().index()]) continue;
                seen[twin.triangle().index()] = true;
                pending.push_back(twin.triangle());
            }
        }
    }
    return found;
}

}  // namespace tinsmith::core
