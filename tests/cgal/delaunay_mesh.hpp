// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/types/mesh_data.hpp"

namespace tinsmith::cgal {

/// The Delaunay triangulation of the points in plan, by CGAL: its domain is their convex hull.
/// Requires: positions differ.
core::MeshData delaunay_mesh(const std::vector<core::Point3>& points);

}  // namespace tinsmith::cgal
