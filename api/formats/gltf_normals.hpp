// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "api/formats/gltf.hpp"
#include "api/formats/gltf_axes.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

/// The sum of the normals of a vertex's triangles, each weighted by its area, in session axes.
struct NormalSum {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
};

/// One for each vertex. Requires: a triangle's corners are distinct. Cost: one pass.
std::vector<NormalSum> normal_sums(const core::MeshData& mesh);

/// The direction of the sum, of length 1, in the file's axes; (0, 0, 1) of the session where the
/// sum is zero.
inline std::array<float, 3> smooth_normal(const NormalSum& sum, UpAxis up) {
    const auto& [x, y, z] = sum;
    const double length = std::sqrt(x * x + y * y + z * z);
    const double scale = 1.0 / length;
    std::array<float, 3> normal{};
    if (scale > 0.0 && std::isfinite(scale)) {
        normal = {static_cast<float>(x * scale), static_cast<float>(y * scale),
                  static_cast<float>(z * scale)};
    } else if (length > 0.0 && std::isfinite(length)) {
        normal = {static_cast<float>(x / length), static_cast<float>(y / length),
                  static_cast<float>(z / length)};
    } else {
        // Triangles of a session are never flat in plan; only rounding to zero comes here.
        normal = {0.0F, 0.0F, 1.0F};
    }
    return to_axes(normal, up);
}

}  // namespace tinsmith::api
