// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "core/types/executor.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/point.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

struct DelaunayOptions {
    /// Is told now and then what share is done; when it says false, the error is Cancelled.
    std::function<bool(double)> progress;
    /// What the two halves of many points are triangulated by. The mesh does not depend on it.
    Executor executor = one_after_another;
    /// So many points are triangulated by halves, which are joined then.
    std::size_t least_to_part = std::size_t{1} << 16;
};

/// The Delaunay triangulation of points in plan, by exact predicates: no vertex is inside the
/// circle through a triangle's corners. Its domain is the points' convex hull.
///
/// Laws: vertices are the points in their order; a point that is there already, with the same
/// elevation, is left out. Every vertex is used, triangles are counter-clockwise: `build_tin`
/// takes the mesh as it is. The same points in the same order give the same mesh, on every
/// compiler; which diagonal four points on a circle get depends on nothing else.
/// Faults, at most kMaxFaults, each with the point's index as its place's vertex: coordinates that
/// are not finite or out of range, a position with two elevations (the place's `earlier` is the
/// point that was there first). Fewer than three positions, or all of them on one line, span no
/// triangle. Cost: about n log n, some 100 bytes a point beside the result.
Result<MeshData> delaunay(std::span<const Point3> points, const DelaunayOptions& options = {});

}  // namespace tinsmith::core
