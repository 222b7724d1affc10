// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/mesh/tin.hpp"

namespace tinsmith::core {

/// What only a removal changes, as it was: beside triangles and vertices, whose slots are kept as
/// for any operation.
struct RemovalRecord {
    bool was_renumbered = false;
    std::vector<std::pair<VertexId, VertexId>> names;  ///< slot, name; of slots given to others
    std::size_t named_splits = 0;
    std::vector<ConstraintSplit> splits;  ///< those after these, told by slot
    std::size_t gone_ends = 0;
    std::size_t built_vertex_count = 0;
    std::vector<TriangleId> components;
    std::vector<std::pair<std::size_t, TriangleId>> hints;  ///< cell, hint; of those that changed
    BoundaryIndex boundary;

    std::size_t memory_bytes() const {
        return sizeof *this + names.size() * sizeof names[0] + splits.size() * sizeof splits[0] +
               components.size() * sizeof components[0] + hints.size() * sizeof hints[0] +
               boundary.memory_bytes();
    }
};

/// What an operation changed in a TIN, enough to take it back bit for bit: the sizes before, and
/// each old slot as it was before its first change. Slots past the old sizes need no copy.
/// Cost to roll back: proportional to what changed.
struct UndoRecord {
    std::size_t vertex_count = 0;
    std::size_t triangle_count = 0;
    std::size_t boundary_changes = 0;  ///< of the boundary index
    std::size_t split_count = 0;       ///< of constraints
    std::uint32_t next_facet = 0;
    std::uint32_t next_name = 0;
    double facet_error = 0.0;
    Bounds bounds;
    bool moved_vertices = false;                                  ///< any, up or down
    std::vector<std::pair<TriangleId, Tin::Triangle>> triangles;  ///< each old slot once
    std::vector<std::pair<VertexId, Tin::Vertex>> vertices;       ///< in order of change
    std::shared_ptr<RemovalRecord> removal;  ///< null: none; changed by its only owner alone
};

/// The records of one operation's parts, in order.
using Undo = std::vector<UndoRecord>;

}  // namespace tinsmith::core
