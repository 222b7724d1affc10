// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/tin.hpp"
#include "core/mesh/undo_record.hpp"

namespace tinsmith::core {

/// The part of the mesh that a request has changed, as it was and as it is, from the records that
/// could take it back.
class Replaced {
  public:
    using Edge = std::pair<VertexId, VertexId>;

    /// Requires: records of one request, from its first on, none taken back.
    Replaced(const Tin& tin, std::span<const UndoRecord> records);

    /// How many vertices there were.
    std::size_t vertex_count() const { return vertex_count_; }
    /// How many constraint splits there were.
    std::size_t split_count() const { return split_count_; }
    /// Slots of triangles that were there before and that anything of was changed, be it a link
    /// alone, with what they held; in order of slot.
    const std::vector<std::pair<TriangleId, const Tin::Triangle*>>& recorded() const {
        return old_;
    }
    /// The corners of the triangles that are no more.
    const std::vector<std::array<VertexId, 3>>& removed() const { return removed_; }
    /// The triangles in their place.
    const std::vector<TriangleId>& added() const { return added_; }
    /// A vertex that was there before, as it was.
    Point3 before(VertexId v) const;
    /// Edges that were constrained, of the triangles that changed; lower vertex first, in order.
    const std::vector<Edge>& constraints() const { return constraints_; }
    /// Edges of the triangles that changed where the surface may have bent, the boundary and
    /// constraints; lower vertex first, in order.
    const std::vector<Edge>& lines() const { return lines_; }

  private:
    const Tin::Triangle& triangle_before(TriangleId t) const;
    void collect_lines();

    const Tin& tin_;
    std::size_t vertex_count_ = 0;
    std::size_t triangle_count_ = 0;
    std::size_t split_count_ = 0;
    std::vector<std::pair<TriangleId, const Tin::Triangle*>> old_;       ///< in order of slot
    std::vector<std::pair<VertexId, const Tin::Vertex*>> old_vertices_;  ///< in order
    std::vector<std::array<VertexId, 3>> removed_;
    std::vector<TriangleId> added_;
    std::vector<Edge> constraints_;
    std::vector<Edge> lines_;
};

}  // namespace tinsmith::core
