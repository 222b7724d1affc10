// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/types/point.hpp"

namespace tinsmith::core {

/// A chain of segments in plan. A closed path joins its last point to its first, which is not
/// repeated at the end. A path of one point is a point to be made a vertex.
struct Path {
    std::vector<Point2> points;
    bool closed = false;
    /// The points' own elevations, one each, linear between them; none: draped on the surface.
    std::vector<double> elevations = {};
};

/// One thing to integrate: a polygon with holes, a multi-line, a set of points.
/// The inside of a region is decided by winding over all its closed paths.
struct Shape {
    std::vector<Path> paths;
};

}  // namespace tinsmith::core
