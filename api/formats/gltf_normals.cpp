// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_normals.hpp"

#include <vector>

namespace tinsmith::api {

std::vector<NormalSum> normal_sums(const core::MeshData& mesh) {
    std::vector<NormalSum> sums(mesh.vertices.size());
    for (const auto& corners : mesh.triangles) {
        const core::Point3& a = mesh.vertices[corners[0]];
        const core::Point3& b = mesh.vertices[corners[1]];
        const core::Point3& c = mesh.vertices[corners[2]];
        const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
        const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
        // The cross product's length is twice the area: the weight comes by itself.
        const NormalSum normal{static_cast<float>(uy * vz - uz * vy),
                               static_cast<float>(uz * vx - ux * vz),
                               static_cast<float>(ux * vy - uy * vx), 0.0F};
        // Corners are distinct: all three are read before one is written, so that none waits.
        NormalSum& at_a = sums[corners[0]];
        NormalSum& at_b = sums[corners[1]];
        NormalSum& at_c = sums[corners[2]];
        const NormalSum new_a = at_a + normal, new_b = at_b + normal, new_c = at_c + normal;
        at_a = new_a;
        at_b = new_b;
        at_c = new_c;
    }
    return sums;
}

}  // namespace tinsmith::api
