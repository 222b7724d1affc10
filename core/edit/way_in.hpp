// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/mesh/tin.hpp"
#include "core/types/ids.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// A place where a straight line p -> q meets the mesh's boundary: inside an edge or at a vertex.
struct BoundaryContact {
    Side side;        ///< the boundary edge that the line crosses; invalid at a vertex
    VertexId vertex;  ///< the vertex that is on the line; invalid inside an edge

    bool is_vertex() const { return vertex.valid(); }
    friend bool operator==(const BoundaryContact&, const BoundaryContact&) = default;
};

/// Whether `a` is met strictly before `b` on the way from p to q. Exact: decided by orientations
/// alone, since edges of the boundary do not cross each other. Requires: both are on the line.
bool is_before(const Tin& tin, Point2 p, Point2 q, const BoundaryContact& a,
               const BoundaryContact& b);

/// Where the segment p -> q may come into the mesh: edges that it crosses from outside in, and
/// boundary vertices on it from which it goes on in the mesh or along its edges. In the order in
/// which they are met. Places in the middle of the mesh's side of the line are not left out.
/// Requires: p != q. Cost: the boundary edges near the segment, times their logarithm, and the
/// degrees of the vertices on it.
std::vector<BoundaryContact> ways_in(const Tin& tin, Point2 p, Point2 q);

}  // namespace tinsmith::core
