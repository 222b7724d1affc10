// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "api/formats/gltf_scene.hpp"

namespace tinsmith::api {
namespace {

/// x, y, z and nothing: two pairs, which a processor adds at a time.
using Sum = std::array<double, 4>;

void add(Sum& to, const Sum& what) {
    for (std::size_t i = 0; i < what.size(); ++i)
        to[i] += what[i];
}

std::array<float, 3> unit_of(const Sum& sum) {
    const auto& [x, y, z, nothing] = sum;
    const double length = std::sqrt(x * x + y * y + z * z);
    // Triangles of a session are never flat in plan; only rounding to zero comes here.
    if (!(length > 0.0) || !std::isfinite(length)) return {0.0F, 0.0F, 1.0F};
    const double scale = 1.0 / length;
    if (!std::isfinite(scale))
        return {static_cast<float>(x / length), static_cast<float>(y / length),
                static_cast<float>(z / length)};
    return {static_cast<float>(x * scale), static_cast<float>(y * scale),
            static_cast<float>(z * scale)};
}

}  // namespace

std::vector<std::array<float, 3>> smooth_normals(const core::MeshData& mesh, UpAxis up) {
    std::vector<Sum> sums(mesh.vertices.size());
    for (const auto& corners : mesh.triangles) {
        const core::Point3& a = mesh.vertices[corners[0]];
        const core::Point3& b = mesh.vertices[corners[1]];
        const core::Point3& c = mesh.vertices[corners[2]];
        const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
        const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
        // The cross product's length is twice the area: the weight comes by itself.
        const Sum normal{uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx, 0.0};
        for (const std::uint32_t vertex : corners)
            add(sums[vertex], normal);
    }
    std::vector<std::array<float, 3>> normals(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        normals[i] = to_axes(unit_of(sums[i]), up);
    return normals;
}

}  // namespace tinsmith::api
