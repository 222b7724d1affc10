// SPDX-License-Identifier: Apache-2.0
#include "tests/support/compact.hpp"

#include <algorithm>
#include <set>

namespace tinsmith::test {

core::MeshData compact(const core::MeshData& full) {
    core::MeshData mesh;
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::vector<bool> used(full.vertices.size(), false);
    for (const auto& t : full.triangles) {
        for (unsigned i = 0; i < 3; ++i) {
            used[t[i]] = true;
            edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
        }
    }
    std::vector<std::uint32_t> slot(full.vertices.size(), UINT32_MAX);
    for (std::size_t v = 0; v < used.size(); ++v) {
        if (!used[v]) continue;
        slot[v] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(full.vertices[v]);
    }
    for (const auto& [a, b, c] : full.triangles)
        mesh.triangles.push_back({slot[a], slot[b], slot[c]});
    for (const auto& [a, b] : full.constraints)
        if (edges.contains(std::minmax(a, b))) mesh.constraints.push_back({slot[a], slot[b]});
    return mesh;
}

}  // namespace tinsmith::test
