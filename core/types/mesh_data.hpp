// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/types/point.hpp"

namespace tinsmith::core {

/// A mesh as plain buffers: what readers make, what `build_tin` takes, what writers encode.
/// Triangles name vertices by index, counter-clockwise seen from above (+z).
/// Constraints are the constrained edges, each once, as pairs of vertex indices.
struct MeshData {
    std::vector<Point3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<std::uint32_t, 2>> constraints;
};

}  // namespace tinsmith::core
