// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/types/mesh_data.hpp"

namespace tinsmith::cgal {

/// The Delaunay triangulation of the points in plan, by CGAL: its domain is their convex hull.
/// Requires: positions differ.
core::MeshData delaunay_mesh(const std::vector<core::Point3>& points);

/// Only made, in the order of CGAL's spatial sort, and its triangles counted: what is timed beside
/// the core's. The second with an index at each vertex, as it takes to hand the mesh on.
std::size_t delaunay_count(const std::vector<core::Point3>& points);
std::size_t delaunay_count_with_indices(const std::vector<core::Point3>& points);

/// Whether the triangles are those of a Delaunay triangulation of their vertices, by CGAL's exact
/// predicates: none has a vertex of a neighbour inside its circle. Requires: a valid mesh that
/// covers the convex hull.
bool is_delaunay(const core::MeshData& mesh);

}  // namespace tinsmith::cgal
