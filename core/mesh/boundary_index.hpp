// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/types/ids.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// Finds boundary edges near a segment. Each edge is registered under its first vertex (the mesh
/// on its left) in every cell of a uniform grid that its box touches. A vertex has one fan of
/// triangles, hence at most one boundary edge starts at it, so the vertex names the edge; after a
/// split the old entries still cover the halves.
/// Promise: `near` names every boundary edge that meets the segment. It may name more.
/// Cost: building linear; a query the cells along the segment plus what they hold.
class BoundaryIndex {
  public:
    BoundaryIndex() = default;
    /// An empty index over the box, sized for so many edges.
    BoundaryIndex(Point2 min, Point2 max, std::size_t edges);

    /// Registers the edge from p, the position of v, to q. Cells that took an entry are appended
    /// to `log` where there is one.
    void add(VertexId v, Point2 p, Point2 q, std::vector<std::size_t>* log = nullptr);
    /// Removes the newest entry of each cell named. Requires: they are the newest ones.
    void remove_newest(const std::vector<std::size_t>& cells);

    /// First vertices of the boundary edges that may meet the segment p-q, in order of id.
    std::vector<VertexId> near(Point2 p, Point2 q) const;

  private:
    std::size_t column(double x) const;
    std::size_t row(double y) const;

    Point2 min_;
    Point2 max_;
    double cells_per_x_ = 0.0;
    double cells_per_y_ = 0.0;
    std::size_t columns_ = 0;
    std::size_t rows_ = 0;
    std::vector<std::vector<VertexId>> cells_;
};

}  // namespace tinsmith::core
