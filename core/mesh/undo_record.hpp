// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "core/mesh/tin.hpp"

namespace tinsmith::core {

/// What an operation changed in a TIN, enough to take it back bit for bit: the sizes before, and
/// each old slot as it was before its first change. Slots past the old sizes need no copy.
/// Cost to roll back: proportional to what changed.
struct UndoRecord {
    std::size_t vertex_count = 0;
    std::size_t triangle_count = 0;
    std::size_t boundary_changes = 0;  ///< of the boundary index
    std::size_t split_count = 0;       ///< of constraints
    std::uint32_t next_facet = 0;
    double facet_error = 0.0;
    Bounds bounds;
    bool moved_vertices = false;                                  ///< any, up or down
    std::vector<std::pair<TriangleId, Tin::Triangle>> triangles;  ///< each old slot once
    std::vector<std::pair<VertexId, Tin::Vertex>> vertices;       ///< in order of change
};

/// The records of one operation's parts, in order.
using Undo = std::vector<UndoRecord>;

}  // namespace tinsmith::core
