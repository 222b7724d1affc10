// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_count.hpp"

#include <vector>

namespace tinsmith::api {

namespace {

constexpr std::size_t kTriangles = 4, kStrip = 5, kFan = 6;

std::size_t told_by(const GltfModel& model, const GltfPrimitive& primitive, std::size_t most) {
    const auto accessor = primitive.indices ? primitive.indices : primitive.position;
    if (!accessor || *accessor >= model.accessors.size()) return 0;
    const std::size_t corners = model.accessors[*accessor].count;
    if (primitive.mode == kTriangles) return corners / 3 > most ? 0 : corners / 3;
    const bool is_row = primitive.mode == kStrip || primitive.mode == kFan;
    return !is_row || corners < 3 || corners - 2 > most ? 0 : corners - 2;
}

}  // namespace

std::size_t told_triangles(const GltfModel& model, std::size_t most) {
    std::vector<std::size_t> of_mesh(model.meshes.size(), 0);
    for (std::size_t i = 0; i < of_mesh.size(); ++i) {
        for (const GltfPrimitive& primitive : model.meshes[i])
            if (of_mesh[i] <= most) of_mesh[i] += told_by(model, primitive, most);
    }
    std::size_t sum = 0;
    std::vector<bool> seen(model.nodes.size(), false);
    std::vector<std::size_t> open = model.roots;
    while (!open.empty() && sum <= most) {
        const std::size_t at = open.back();
        open.pop_back();
        if (at >= seen.size() || seen[at]) continue;  // others tell that these are no tree
        seen[at] = true;
        const GltfNode& node = model.nodes[at];
        open.insert(open.end(), node.children.begin(), node.children.end());
        if (node.mesh && *node.mesh < of_mesh.size()) sum += of_mesh[*node.mesh];
    }
    return sum;
}

}  // namespace tinsmith::api
