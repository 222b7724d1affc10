// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "api/formats/gltf.hpp"
#include "api/formats/gltf_normals.hpp"
#include "api/formats/gltf_writer.hpp"
#include "api/formats/quantization.hpp"
#include "api/unwritten.hpp"
#include "core/types/executor.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

/// Triangles that lie in the same polygons.
struct SceneGroup {
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint16_t> features;  ///< rows of the newest polygons; see GlbPrimitive
    std::vector<std::string> polygons;    ///< ids of all, in the order in which they came
};

/// A group for each set that has triangles: the ground, if any is left, and then the regions.
std::vector<SceneGroup> groups_of(const RegionPartition& regions);

/// What the mesh's primitives are made of. `normals` as from normal_sums, or empty: none are
/// wanted. Where there are groups, each triangle is in one of them.
struct SceneInput {
    const core::MeshData& mesh;
    const GltfOptions& options;
    std::span<const NormalSum> normals;
    std::span<const SceneGroup> groups;
};

struct ScenePlan;

/// The planned primitives on the grid, with Draco or meshopt; see write_glb. Each is a job for the
/// executor, and none of them waits for another. Requires: a valid mesh, `points` as from quantize.
std::variant<std::vector<GlbNode>, EncodeError> grid_nodes(const SceneInput& input,
                                                           const ScenePlan& plan,
                                                           const PositionGrid& grid,
                                                           std::span<const GridPoint> points,
                                                           const core::Executor& executor);

/// Where all vertices are, in the file's axes.
struct PlainPositions {
    Unwritten<std::array<float, 3>> vertices;
    Box<float> box;
};

/// One node with the mesh in its own order, or group by group, `positions` from `origin`, which is
/// in session axes; and constraint lines.
GlbNode plain_node(const SceneInput& input, const std::array<double, 3>& origin,
                   PlainPositions positions, const core::Executor& executor);

}  // namespace tinsmith::api
