// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "api/formats/gltf_pieces.hpp"
#include "api/formats/gltf_scene.hpp"
#include "api/formats/quantization.hpp"

namespace tinsmith::api {

/// More triangles than these that would be one compressed primitive are halved, and again, so that
/// they can be encoded at the same time. Halves lie beside each other on one grid, and vertices
/// between them decode to the same bits in both.
inline constexpr std::size_t kMostInOnePiece = std::size_t{1} << 19;

/// What becomes one primitive.
struct PlannedPiece {
    enum class As { Draco, Meshopt, PlainTriangles, Lines };

    As as = As::Draco;
    const SceneGroup* group = nullptr;  ///< null: not of regions
    Items items;                        ///< triangles of the mesh, or its constraints
};

struct ScenePlan {
    std::vector<PlannedPiece> pieces;  ///< in the order of the file
    bool one_node = true;              ///< float32 reaches the whole mesh from the grid's origin
};

/// How the mesh on its grid is taken apart: by its groups, each as few pieces as codecs and float32
/// allow, large ones halved; then the constraints. The same whatever machine it is.
/// Cost: two passes over the triangles for each halving, and those of split_into_tiles.
std::variant<ScenePlan, EncodeError> plan_scene(const SceneInput& input, const PositionGrid& grid,
                                                std::span<const GridPoint> points);

}  // namespace tinsmith::api
