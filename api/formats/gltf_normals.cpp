// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "api/formats/gltf_scene.hpp"

namespace tinsmith::api {
namespace {

struct Vector {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;

    Vector operator+(const Vector& v) const { return {x + v.x, y + v.y, z + v.z}; }
};

std::array<float, 3> unit_of(const Vector& sum) {
    const auto& [x, y, z] = sum;
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
    std::vector<Vector> sums(mesh.vertices.size());
    for (const auto& corners : mesh.triangles) {
        const core::Point3& a = mesh.vertices[corners[0]];
        const core::Point3& b = mesh.vertices[corners[1]];
        const core::Point3& c = mesh.vertices[corners[2]];
        const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
        const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
        // The cross product's length is twice the area: the weight comes by itself.
        const Vector normal{uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
        // Corners are distinct: all three are read before one is written, so that none waits.
        Vector& at_a = sums[corners[0]];
        Vector& at_b = sums[corners[1]];
        Vector& at_c = sums[corners[2]];
        const Vector new_a = at_a + normal, new_b = at_b + normal, new_c = at_c + normal;
        at_a = new_a;
        at_b = new_b;
        at_c = new_c;
    }
    std::vector<std::array<float, 3>> normals(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        normals[i] = to_axes(unit_of(sums[i]), up);
    return normals;
}

}  // namespace tinsmith::api
