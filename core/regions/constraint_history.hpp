// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/tin.hpp"

namespace tinsmith::core {

/// Tells what became of constrained edges since they were made. Constrained edges never swap, so
/// they can only have been split, and the mesh recorded each split.
/// It is of the mesh as it was when the history was made: make a new one after each operation.
/// Cost: building n log n in the splits; memory 24 bytes for each.
class ConstraintHistory {
  public:
    explicit ConstraintHistory(const Tin& tin);

    /// The chain as it lies in the mesh now: the same line with the vertices that split it since,
    /// each joined to the next by a constrained edge.
    /// Requires: the chain was recorded on this mesh, by an operation that was not taken back.
    /// Where that is broken, pairs that no constrained edge joins are left as they are.
    /// Cost: the chain as it is now, times the logarithm of the splits and the vertices' degrees.
    std::vector<VertexId> expand(std::span<const VertexId> chain) const;

    /// All constrained edges along the chain: those of `expand`; and where rounding brought an edge
    /// back that had been split, the edge as well as its parts, which lie beside it within
    /// rounding. Each edge by its ends, some perhaps more than once. Requirements and cost as
    /// above.
    std::vector<std::pair<VertexId, VertexId>> edges_along(std::span<const VertexId> chain) const;

  private:
    struct Split {
        std::uint64_t edge;  ///< both ends, whichever way round
        std::size_t index;   ///< in `Tin::constraint_splits`
        VertexId p;
    };
    /// The splits of the edge, oldest first.
    std::span<const Split> splits_of(VertexId a, VertexId b) const;
    bool is_constrained(VertexId a, VertexId b) const;

    const Tin& tin_;
    std::vector<Split> splits_;  ///< by edge, then by age
};

/// One number for the edge between two vertices, whichever way round.
constexpr std::uint64_t edge_key(VertexId a, VertexId b) {
    const auto [low, high] = a < b ? std::pair{a, b} : std::pair{b, a};
    return std::uint64_t{low.value} << 32 | high.value;
}

}  // namespace tinsmith::core
