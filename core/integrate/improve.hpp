// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/surgery.hpp"

namespace tinsmith::core {

/// Swaps edges inside facets until each facet's triangles are the constrained Delaunay
/// triangulation of its vertices in the facet's own plane: the largest smallest angles that can be
/// had without moving the surface (the paper's section 3.4, held to its shape-preserving part).
/// Constrained, locked and boundary edges and edges between facets never swap.
///
/// What holds afterwards, for each edge that may swap, around the vertices and wherever a swap
/// reached: the angles across from it sum to no more than 180 degrees; or to so little more that
/// the smaller of the smallest angles on either side would not grow by a part in 2^36. Where both
/// diagonals are as good as that, on four corners of a circle, the one stays or comes that gives
/// the larger of the two smallest angles more; but for `improve_across`, which may leave either.
class Improver {
  public:
    explicit Improver(Surgery& surgery)
        : surgery_(surgery), tin_(surgery.tin()), seen_(tin_.vertex_count()) {}

    /// Improves around the vertices and as far as swaps reach from there. Requires: the vertices
    /// that are new since the last call, or since the beginning, are among them. Ends: each swap
    /// makes the sorted list of all triangles' smallest angles, as they are rounded for comparing,
    /// larger in lexicographic order, but for so many as are not asked for that, and there are
    /// finitely many triangulations. Cost: linear in the swaps.
    void improve(const std::vector<VertexId>& vertices);

    /// Improves around a new vertex at once, so that it need not be among those of the next call:
    /// the edges across from it, by their sides there, and as far as swaps reach from these.
    /// `is_known`: no edge of the facets around it would have been better swapped before it came.
    /// Then only edges across from it can fail (Lawson 1977), and of two diagonals that are as good
    /// either may be there; each swap takes one away that does not end at the vertex. Cost: linear
    /// in the swaps, whose number it returns.
    std::uint64_t improve_across(std::span<const Side> outer, bool is_known);

    /// Swaps one edge if it is free to and better swapped. False: it stays.
    bool improve(Side s);

    std::uint64_t edges_swapped() const { return edges_swapped_; }

  private:
    /// The ends of an edge and the vertices across from it, on its left and right.
    struct Quad {
        VertexId a, b, c, d;
    };

    static bool is_named_again(const std::vector<VertexId>& vertices, std::size_t i);
    void add_star(VertexId v);
    void add_at(Side side, std::uint32_t newest);
    template <typename Add>
    void swap_pending(const Add& add);
    bool may_swap(Side s) const;
    bool should_swap(Side s);
    bool is_better_swapped(const Quad& quad) const;

    Surgery& surgery_;
    const Tin& tin_;
    std::size_t seen_;  ///< vertices that were there when the last call ended
    std::vector<Side> pending_;
    /// So many edges that plainly fail Delaunay's condition are swapped without asking the angles.
    /// These would tell the same but for rounding, which must not keep swaps going for ever.
    std::size_t unasked_ = 0;
    std::uint64_t edges_swapped_ = 0;
};

}  // namespace tinsmith::core
