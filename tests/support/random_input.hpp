// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <vector>

#include "core/integrate/shape.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::test {

using Random = std::mt19937_64;

/// The kinds of meshes that the guarantees are tried on.
enum class MeshKind {
    Grid,      ///< regular: every alignment is exact
    Jittered,  ///< a grid with moved posts
    Concave,   ///< a grid with cells missing at the rim
    Holes,     ///< a grid with cells missing anywhere: holes, components, fans that touch
    Needles,   ///< a grid squeezed to cells of 1e-9 height
    FarAway,   ///< fine detail (1e-3) at an offset of 5e6
};
inline constexpr int kMeshKinds = 6;

enum class ShapeKind {
    Ring,     ///< star-shaped around a point
    Line,     ///< open, random
    Tangled,  ///< closed, self-intersecting
    Lattice,  ///< points on posts, edges and cell centres only
    Spike,    ///< runs back on itself
    Tiny,     ///< much smaller than a triangle
};
inline constexpr int kShapeKinds = 6;

double uniform(Random& random, double low, double high);

/// A mesh of about `columns` x `columns` cells.
core::MeshData random_mesh(Random& random, MeshKind kind, int columns);
/// A shape on and around the mesh.
core::Shape random_shape(Random& random, ShapeKind kind, const core::MeshData& mesh);

}  // namespace tinsmith::test
