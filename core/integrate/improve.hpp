// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/surgery.hpp"

namespace tinsmith::core {

/// Swaps edges inside facets until each facet's triangles are the constrained Delaunay
/// triangulation of its vertices in the facet's own plane: the largest smallest angles that can be
/// had without moving the surface (the paper's section 3.4, held to its shape-preserving part).
/// Constrained, locked and boundary edges and edges between facets never swap.
class Improver {
  public:
    explicit Improver(Surgery& surgery) : surgery_(surgery), tin_(surgery.tin()) {}

    /// Improves around the vertices and as far as swaps reach from there. Ends: every swap makes
    /// the smaller of two triangles' smallest angles larger, so the sorted list of all of them
    /// only grows, and there are finitely many triangulations. Cost: linear in the swaps.
    void improve(const std::vector<VertexId>& vertices);

    std::uint64_t edges_swapped() const { return edges_swapped_; }

  private:
    void push_star(VertexId v);
    bool should_swap(Side s) const;

    Surgery& surgery_;
    const Tin& tin_;
    std::vector<Side> pending_;
    std::uint64_t edges_swapped_ = 0;
};

}  // namespace tinsmith::core
