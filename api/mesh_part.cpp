// SPDX-License-Identifier: Apache-2.0
#include "api/mesh_part.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <unordered_set>

#include "core/predicates/orientation.hpp"

namespace tinsmith::api {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Two convex shapes are apart exactly where a side of one of them has the other beyond it.
bool meets(const PlanBox& box, const std::array<core::Point2, 3>& t) {
    const auto [low_x, high_x] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [low_y, high_y] = std::minmax({t[0].y, t[1].y, t[2].y});
    if (high_x < box.min_x || low_x > box.max_x || high_y < box.min_y || low_y > box.max_y)
        return false;
    const std::array<core::Point2, 4> corners{{{box.min_x, box.min_y},
                                               {box.max_x, box.min_y},
                                               {box.max_x, box.max_y},
                                               {box.min_x, box.max_y}}};
    for (std::size_t i = 0; i < 3; ++i) {
        // Triangles run counter-clockwise: what is beyond a side lies clockwise of it.
        const bool is_beyond = std::all_of(corners.begin(), corners.end(), [&](core::Point2 p) {
            return core::orientation(t[i], t[(i + 1) % 3], p) == core::Orientation::Clockwise;
        });
        if (is_beyond) return false;
    }
    return true;
}

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    return std::uint64_t{low} << 32 | high;
}

}  // namespace

MeshPart part_within(const core::MeshData& mesh, const PlanBox& box) {
    const auto plan = [&](std::uint32_t vertex) {
        return core::Point2{mesh.vertices[vertex].x, mesh.vertices[vertex].y};
    };
    MeshPart part;
    std::vector<std::uint32_t> number(mesh.vertices.size(), kNone);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        if (!meets(box, {plan(a), plan(b), plan(c)})) continue;
        part.triangles.push_back(t);
        number[a] = number[b] = number[c] = 0;
    }
    for (std::uint32_t vertex = 0; vertex < number.size(); ++vertex) {
        if (number[vertex] == kNone) continue;
        number[vertex] = static_cast<std::uint32_t>(part.mesh.vertices.size());
        part.mesh.vertices.push_back(mesh.vertices[vertex]);
    }
    std::unordered_set<std::uint64_t> edges;
    for (const std::uint32_t t : part.triangles) {
        const auto& [a, b, c] = mesh.triangles[t];
        part.mesh.triangles.push_back({number[a], number[b], number[c]});
        if (mesh.constraints.empty()) continue;
        edges.insert({key_of(a, b), key_of(b, c), key_of(c, a)});
    }
    for (const auto& [a, b] : mesh.constraints) {
        if (edges.contains(key_of(a, b))) part.mesh.constraints.push_back({number[a], number[b]});
    }
    return part;
}

}  // namespace tinsmith::api
