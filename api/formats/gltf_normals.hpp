// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "api/formats/gltf.hpp"
#include "api/formats/gltf_axes.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

/// The sum of the normals of a vertex's triangles, each weighted by its area, in session axes: x,
/// y, z and a zero, in one register.
typedef float NormalSum __attribute__((vector_size(16)));  // NOLINT(modernize-use-using): GCC 12

/// One for each vertex. Each normal is computed in doubles, for needles are differences of what is
/// almost the same. Requires: a triangle's corners are distinct. Cost: one pass.
std::vector<NormalSum> normal_sums(const core::MeshData& mesh);

/// Of squares between these float32 loses nothing that matters.
inline constexpr float kLeastSquare = 0x1p-90F, kLargestSquare = 0x1p120F;

/// The direction of the sum, of length 1, in the file's axes; (0, 0, 1) of the session where the
/// sum is zero.
inline std::array<float, 3> smooth_normal(const NormalSum& sum, UpAxis up) {
    const NormalSum squares = sum * sum;
    const float squared = squares[0] + squares[1] + squares[2];
    if (squared > kLeastSquare && squared < kLargestSquare) {
        const NormalSum normal = sum * (1.0F / std::sqrt(squared));
        return to_axes(std::array{normal[0], normal[1], normal[2]}, up);
    }
    const double x = double{sum[0]}, y = double{sum[1]}, z = double{sum[2]};
    const double length = std::sqrt(x * x + y * y + z * z);
    // Triangles of a session are never flat in plan; only rounding to zero comes to none.
    if (!(length > 0.0 && std::isfinite(length))) return to_axes(std::array{0.0F, 0.0F, 1.0F}, up);
    return to_axes(std::array{static_cast<float>(x / length), static_cast<float>(y / length),
                              static_cast<float>(z / length)},
                   up);
}

}  // namespace tinsmith::api
