// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <variant>

#include "api/formats/gltf_error.hpp"
#include "api/formats/gltf_regions.hpp"
#include "core/types/executor.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

enum class Compression { Draco, Meshopt, None };
enum class UpAxis { Y, Z };

struct GltfOptions {
    Compression compression = Compression::Draco;
    double tolerance = 0.005;    ///< metres: the largest error that any coordinate may have
    UpAxis up = UpAxis::Y;       ///< Y, as glTF wants it: (x, z, -y). Z: (x, y, z)
    bool constraints = true;     ///< constraint edges as a primitive of mode LINES
    bool normals = true;         ///< smooth, weighted by area
    double unit_to_metre = 1.0;  ///< length of the mesh's unit; glTF is always in metres
    std::string crs = {};        ///< told in the scene's `extras`; empty: nothing is said
};

/// The file and what can be said of it. All lengths in metres, axes of the session (z up).
struct GltfResult {
    std::string bytes;
    std::array<double, 3> origin{};      ///< whole metres; all positions are relative to it
    std::array<double, 3> axis_error{};  ///< measured: |origin + decoded - vertex|, largest of all
    double max_error = 0.0;              ///< the largest of the three; never above the tolerance
    double step = 0.0;                   ///< of the position grid, a power of two; 0: plain float32
    unsigned bits = 0;                   ///< most position bits of a primitive; 0: no Draco used
    std::size_t primitives = 0;          ///< of triangles
    std::size_t nodes = 0;
    std::size_t flipped = 0;    ///< triangles that rounding turned clockwise
    std::size_t collapsed = 0;  ///< triangles that rounding left without area in plan
};

/// Writes a session's mesh as binary glTF 2.0.
///
/// Draco and meshopt: positions lie on one grid of a power of two and decode to exactly that grid
/// in float32. It is the coarsest that the tolerance allows, or a finer one that one primitive can
/// still hold, where fewer triangles are flipped or collapsed there. Usually that is one primitive,
/// or, beyond kMostInOnePiece triangles (524,288), several side by side with about as many
/// triangles. A mesh wider than 2^23 steps (65 km at 5 mm) becomes several, cut along triangles,
/// and border vertices decode to the same bits in both; triangles wider than half of that go into
/// an uncompressed primitive on the same grid. All share one node, so that a GPU rounds them alike.
/// A mesh wider than 2^25 steps (262 km at 5 mm) no longer fits one node's float32: then each
/// primitive has its own node with a whole-metre translation, translation + position still agree
/// exactly in double across borders, but a GPU may show a hairline there. Meshopt has other widths,
/// 2^24 and 2^25 steps, and no uncompressed triangles. Both permute vertices.
///
/// None: float32 positions in the mesh's vertex order, u32 indices in its triangle order, one
/// primitive.
///
/// With regions each set of triangles is a primitive of its own, or several as above; vertices at
/// the borders are in each and decode to the same bits. EXT_mesh_features names the polygons that
/// contain it, the newest first, at most kMostFeatureSets of them, as rows of the property table
/// (EXT_structural_metadata); the primitive's `extras` name all, and the scene's describe them.
///
/// Triangles have a matt grey material that is seen from both sides, lines a dark one.
/// Constraint edges are never compressed and have the very positions of the mesh. What the result
/// says is also in the scene's `extras`. The same mesh and options give the same bytes.
/// Every vertex should be used by a triangle. Cost: Draco's, about 0.2 s for a million triangles,
/// and a few passes over the mesh. Normals are a job for the executor, positions another, and then
/// each primitive; the bytes are the same however it does them.
/// Requires of regions: a set for each triangle; at most kMostRegionFeatures.
std::variant<GltfResult, EncodeError> write_glb(
    const core::MeshData& mesh, const GltfOptions& options,
    const RegionPartition* regions = nullptr,
    const core::Executor& executor = core::one_after_another);

/// The same scene as glTF's JSON, its buffer embedded as a data URI.
std::variant<GltfResult, EncodeError> write_gltf(
    const core::MeshData& mesh, const GltfOptions& options,
    const RegionPartition* regions = nullptr,
    const core::Executor& executor = core::one_after_another);

}  // namespace tinsmith::api
