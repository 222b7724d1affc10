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
    Delaunay,  ///< random points, some triangles missing: concave, holes, components
    Steep,     ///< a jittered grid of cliffs
    Flat,      ///< a jittered grid in one sloping plane: the surface bends nowhere
    Map,       ///< random points at map coordinates of 5e5, 5e6
    Strips,    ///< long thin triangles, all of a length, slanting
    Islands,   ///< several patches apart
};
inline constexpr int kMeshKinds = 12;
const char* name_of(MeshKind kind);

enum class ShapeKind {
    Ring,         ///< star-shaped around a point
    Line,         ///< open, random
    Tangled,      ///< closed, self-intersecting
    Lattice,      ///< points on posts, edges and cell centres only
    Spike,        ///< runs back on itself
    Tiny,         ///< much smaller than a triangle
    Holed,        ///< a ring with rings inside
    Rings,        ///< several rings, apart or over one another
    Lines,        ///< several lines
    Points,       ///< paths of one point, some twice
    Repeated,     ///< a line whose points come twice in a row and again later
    NearLattice,  ///< like Lattice, moved by a few ulps
    Sliver,       ///< a ring much longer than it is wide
    Around,       ///< a ring around the whole mesh, or just at its rim
    AlongEdges,   ///< follows edges of the mesh
    OneTriangle,  ///< many points inside one triangle
};
inline constexpr int kShapeKinds = 16;

double uniform(Random& random, double low, double high);
/// One of 0 .. count - 1.
int pick(Random& random, int count);

/// A mesh of about `columns` x `columns` cells; empty where chance left no triangle.
core::MeshData random_mesh(Random& random, MeshKind kind, int columns);
/// A shape on and around the mesh.
core::Shape random_shape(Random& random, ShapeKind kind, const core::MeshData& mesh);
/// Elevations of its own for each path, within and somewhat beyond those of the mesh.
void give_elevations(Random& random, core::Shape& shape, const core::MeshData& mesh);

}  // namespace tinsmith::test
