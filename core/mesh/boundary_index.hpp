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
/// triangles, hence at most one boundary edge starts at it, so the vertex names the edge. When an
/// edge is split, its entry stays with the longer half, and the shorter gets one of its own: no
/// place is covered by many, however often an edge is split.
/// Promise: `near` names every boundary edge that meets the segment. It may name more.
/// Cost: building linear; a query the cells along the segment plus what they hold.
class BoundaryIndex {
  public:
    BoundaryIndex() = default;
    /// An empty index over the box, sized for so many edges.
    BoundaryIndex(Point2 min, Point2 max, std::size_t edges);

    /// Registers the edge from p, the position of v, to q. Cost: the cells it touches; the grid
    /// gets finer with the edges, at no more than a constant for each in all.
    void add(VertexId v, Point2 p, Point2 q);
    /// Registers the halves of the edge from a, the position of v, to b, which was split at p, the
    /// position of w.
    void add_split(VertexId v, Point2 a, VertexId w, Point2 p, Point2 b);
    /// How many changes were made; `take_back` goes back to one of these.
    std::size_t changes() const { return changes_.size(); }
    /// Takes the newest changes back, so that the first `count` are left.
    void take_back(std::size_t count);

    /// First vertices of the boundary edges that may meet the segment p-q, in order of id.
    std::vector<VertexId> near(Point2 p, Point2 q) const;

    std::size_t memory_bytes() const;

  private:
    struct Entry {
        VertexId vertex;
        Point2 p;
        Point2 q;
    };
    /// The newest entry was made; and perhaps an older one was given to another vertex.
    struct Change {
        std::uint32_t renamed = UINT32_MAX;  ///< that entry; all ones: none
        VertexId before;                     ///< whose it was
    };
    struct CellRange {
        std::size_t left, right, low, high;
    };

    void make_grid(std::size_t edges);
    CellRange cells_of(const Entry& entry) const;
    void file(std::uint32_t entry);
    void append(const Entry& entry);
    std::uint32_t find(VertexId v, Point2 p) const;
    std::size_t column(double x) const;
    std::size_t row(double y) const;

    Point2 min_;
    Point2 max_;
    std::vector<Entry> entries_;
    double cells_per_x_ = 0.0;
    double cells_per_y_ = 0.0;
    std::size_t columns_ = 0;
    std::size_t rows_ = 0;
    std::vector<std::vector<std::uint32_t>> cells_;  ///< entries, oldest first
    std::vector<Change> changes_;
};

}  // namespace tinsmith::core
