// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "api/formats/gltf.hpp"
#include "api/formats/gltf_writer.hpp"
#include "api/formats/quantization.hpp"
#include "core/types/executor.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

/// A position or direction of the session (z up) in the file's axes. Counter-clockwise seen from
/// above stays so: both are rotations.
template <typename T>
std::array<T, 3> to_axes(const std::array<T, 3>& v, UpAxis up) {
    if (up == UpAxis::Z) return v;
    return {v[0], v[2], T{0} - v[1]};  // 0 - 0 is 0, where -0 would be minus zero
}

/// A direction for each vertex, in the file's axes, of length 1: the sum of its triangles' normals,
/// each weighted by its area. (0, 0, 1) where that is zero. Requires: a triangle's
/// corners are distinct. Cost: one pass.
std::vector<std::array<float, 3>> smooth_normals(const core::MeshData& mesh, UpAxis up);

/// Triangles that lie in the same polygons.
struct SceneGroup {
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint16_t> features;  ///< rows of the newest polygons; see GlbPrimitive
    std::vector<std::string> polygons;    ///< ids of all, in the order in which they came
};

/// A group for each set that has triangles: the ground, if any is left, and then the regions.
std::vector<SceneGroup> groups_of(const RegionPartition& regions);

/// What the mesh's primitives are made of. `normals` as from smooth_normals, or empty. Where there
/// are groups, each triangle is in one of them.
struct SceneInput {
    const core::MeshData& mesh;
    const GltfOptions& options;
    std::span<const std::array<float, 3>> normals;
    std::span<const SceneGroup> groups;
};

/// Primitives on the grid, with Draco or meshopt, as `plan_scene` has it; see write_glb. Each is a
/// job for the executor, and none of them waits for another. Requires: a valid mesh, `points` as
/// from quantize.
std::variant<std::vector<GlbNode>, EncodeError> grid_nodes(const SceneInput& input,
                                                           const PositionGrid& grid,
                                                           std::span<const GridPoint> points,
                                                           const core::Executor& executor);

/// One node with the mesh in its own order, or group by group, `positions` in session axes from
/// `origin`, and constraint lines.
GlbNode plain_node(const SceneInput& input, const std::array<double, 3>& origin,
                   std::span<const std::array<float, 3>> positions);

}  // namespace tinsmith::api
