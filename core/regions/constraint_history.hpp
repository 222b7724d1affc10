// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/tin.hpp"

namespace tinsmith::core {

/// Tells what became of constrained edges since they were made. Constrained edges never swap, so
/// they can only have been split, and the mesh recorded each split; or a removal took them away.
/// Chains and what is made of them here name vertices (`Tin::name`): where nothing was ever removed
/// a name is the vertex's slot.
/// It is of the mesh as it was when the history was made: make a new one after each operation.
/// Cost: building n log n in the splits, and in the vertices once anything was removed; memory 24
/// bytes for each of the former, 8 for each of the latter.
class ConstraintHistory {
  public:
    explicit ConstraintHistory(const Tin& tin);

    /// The chain as it lies in the mesh now: the same line with the vertices that split it since,
    /// each joined to the next by a constrained edge, or by one that is gone.
    /// Requires: the chain was recorded on this mesh, by an operation that was not taken back.
    /// Where that is broken, pairs that no constrained edge joins are left as they are.
    /// Cost: the chain as it is now, times the logarithm of the splits and the vertices' degrees.
    std::vector<VertexId> expand(std::span<const VertexId> chain) const;

    /// What of the chain the mesh holds, by slots: each vertex joined to the next by an edge. Where
    /// a removal took edges, or parted the mesh at a vertex, one line ends and another begins. A
    /// chain of one vertex is a line of that one. Requirements and cost as above.
    std::vector<std::vector<VertexId>> lines_along(std::span<const VertexId> chain) const;

    /// All constrained edges along the chain: those of `expand`; and where rounding brought an edge
    /// back that had been split, the edge as well as its parts, which lie beside it within
    /// rounding. Each edge by the slots of its ends, some perhaps more than once. Requirements and
    /// cost as above.
    std::vector<std::pair<VertexId, VertexId>> edges_along(std::span<const VertexId> chain) const;

    /// The edge between two vertices, from the first to the second or the other way round; invalid
    /// where the mesh has none. `origin_is_first` says which.
    struct Edge {
        Side side;
        bool origin_is_first = false;
    };
    Edge edge_between(VertexId a, VertexId b) const;
    /// Calls `visit` with each slot of a name, in order: one; several where a removal parted the
    /// mesh there; none where the vertex is gone.
    template <typename Visit>
    void for_each_slot(VertexId name, Visit visit) const {
        if (!tin_.is_renumbered()) return visit(name);
        auto found = std::lower_bound(slots_.begin(), slots_.end(), std::pair(name, VertexId{0}));
        for (; found != slots_.end() && found->first == name; ++found)
            visit(found->second);
    }
    /// Where the vertex is, or was; nothing where no constrained edge ever ended at one that is
    /// gone.
    std::optional<Point2> plan_of(VertexId name) const;

  private:
    struct Split {
        std::uint64_t edge = 0;  ///< both ends, whichever way round
        std::size_t index = 0;   ///< in `Tin::constraint_splits`
        VertexId p;
    };
    /// The splits of the edge, oldest first.
    std::span<const Split> splits_of(VertexId a, VertexId b) const;
    bool is_constrained(VertexId a, VertexId b) const;
    const Tin& tin_;
    std::vector<Split> splits_;                         ///< by edge, then by age
    std::vector<std::pair<VertexId, VertexId>> slots_;  ///< name, slot; none: all are the same
    std::vector<GoneEnd> gone_ends_;                    ///< by name
};

/// One number for the edge between two vertices, whichever way round.
constexpr std::uint64_t edge_key(VertexId a, VertexId b) {
    const auto [low, high] = a < b ? std::pair{a, b} : std::pair{b, a};
    return std::uint64_t{low.value} << 32 | high.value;
}

}  // namespace tinsmith::core
