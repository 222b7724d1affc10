// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/types/ids.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// Finds boundary edges near a segment. Each edge is registered under its first vertex (the mesh
/// on its left). A vertex has one fan of triangles, hence at most one boundary edge starts at it,
/// so the vertex names the edge. When an edge is split, its entry stays with the longer half, and
/// the shorter gets one of its own: no place is covered by many, however often an edge is split.
///
/// The box is a coarse grid of cells, which are halved, and their halves again, wherever many edges
/// are: so a border of a hundred thousand edges in one straight line costs no more to ask than one
/// spread over the box.
/// Promise: `near` names every boundary edge that comes within the margin, or within rounding, of
/// the segment. It may name more. What it names depends on the changes that are left, not on those
/// that were taken back.
/// Cost: a change or a short query the logarithm of the edges; a long query the parts along it plus
/// what they hold. Long edges side by side, all in one place, are told apart up to a budget only.
class BoundaryIndex {
  public:
    BoundaryIndex() = default;
    /// An empty index over the box, with room for so many edges.
    BoundaryIndex(Point2 min, Point2 max, std::size_t edges);

    /// Registers the edge from p, the position of v, to q.
    void add(VertexId v, Point2 p, Point2 q);
    /// Registers the halves of the edge from a, the position of v, to b, which was split at p, the
    /// position of w.
    void add_split(VertexId v, Point2 a, VertexId w, Point2 p, Point2 b);
    /// How many changes were made; `take_back` goes back to one of these.
    std::size_t changes() const { return changes_.size(); }
    /// Takes the newest changes back, so that the first `count` are left, bit for bit.
    void take_back(std::size_t count);

    /// First vertices of the boundary edges that may come within the margin of the segment p-q, in
    /// x and in y, in order of id.
    std::vector<VertexId> near(Point2 p, Point2 q, double margin = 0.0) const;

    std::size_t memory_bytes() const;

  private:
    friend struct TinState;

    struct Entry {
        VertexId vertex;
        Point2 p;
        Point2 q;
    };
    /// The newest entry was made; and perhaps an older one was given to another vertex.
    struct Change {
        std::size_t entries = 0;             ///< there before
        std::size_t halvings = 0;            ///< made before
        std::uint32_t renamed = UINT32_MAX;  ///< that entry; all ones: none
        VertexId before;                     ///< whose it was
    };
    struct Box {  // plain, so that room for many costs nothing
        double left, low, right, high;
    };
    /// A part of the box.
    struct Node {
        std::uint32_t halves = 0;            ///< the lower one, the upper follows; 0: not halved
        bool by_y = false;                   ///< halved across y
        std::vector<std::uint32_t> entries;  ///< oldest first; of a halved one, those until then
    };
    struct Part {
        std::uint32_t node;
        Box box;
    };

    static Box half_of(const Box& box, bool by_y, bool upper);
    template <typename Visit>
    void for_each_cell(Point2 p, Point2 q, double margin, Visit visit) const;
    bool touches(const Box& box, Point2 p, Point2 q, double margin) const;
    template <typename Visit>
    void for_each_part(Point2 p, Point2 q, double margin, Visit visit) const;
    template <typename Visit>
    void for_each_part_of(const Part& cell, Point2 p, Point2 q, double margin, Visit& visit) const;
    void append(const Entry& entry);
    void halve_where_crowded(Part part);
    bool halve(const Part& part);
    void take_back_halving();
    std::uint32_t find(VertexId v, Point2 p) const;

    Box box_{};
    std::size_t columns_ = 0;
    std::size_t rows_ = 0;
    double rounding_ = 0.0;  ///< more than what rounding does to any position in the box
    std::vector<Entry> entries_;
    std::vector<Node> nodes_;            ///< the grid's cells first, row by row
    std::vector<std::uint32_t> halved_;  ///< nodes, in the order in which they were halved
    std::size_t filed_ = 0;              ///< entries of all nodes that are not halved
    std::vector<Change> changes_;
};

}  // namespace tinsmith::core
