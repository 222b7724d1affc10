// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/mesh/tin.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// The side of triangle t that starts at v. Requires: v is a vertex of t.
Side side_from(const Tin& tin, TriangleId t, VertexId v);
/// Any side that starts at v, as the vertex's own triangle has it.
inline Side side_from(const Tin& tin, VertexId v) {
    return side_from(tin, tin.vertex(v).triangle, v);
}
/// A side of the edge that joins v and w, in either direction; invalid where none does.
/// Cost: the lower of their degrees.
Side find_edge(const Tin& tin, VertexId v, VertexId w);
/// The boundary side that starts at v; invalid where v is inside the mesh.
Side boundary_side_from(const Tin& tin, VertexId v);

/// Calls `visit` once with a side of each edge at v, in the same order each time. Whether the side
/// starts or ends at v depends on the boundary. Cost: v's degree.
template <typename Visit>
void for_each_side_at(const Tin& tin, VertexId v, Visit visit) {
    const Side start = side_from(tin, v);
    Side last;
    Side s = start;
    do {  // counter-clockwise; beyond each triangle its side that ends at v
        visit(s);
        last = s.previous();
        s = tin.twin(last);
    } while (s.valid() && s != start);
    if (s.valid()) return;
    visit(last);
    for (s = tin.twin(start); s.valid(); s = tin.twin(s)) {  // clockwise
        s = s.next();
        visit(s);
    }
}

/// The first thing that a straight line meets on leaving a vertex.
struct Departure {
    enum class Kind : std::uint8_t {
        AlongEdge,    ///< it runs along the edge `side`, one end of which is the vertex
        ThroughEdge,  ///< it crosses the triangle whose side across from the vertex is `side`
        Outside,      ///< it leaves the mesh at once
    };
    Kind kind = Kind::Outside;
    Side side;

    /// The other end of the edge, when AlongEdge.
    VertexId along(const Tin& tin, VertexId from) const {
        const VertexId origin = tin.origin(side);
        return origin == from ? tin.destination(side) : origin;
    }
};

/// Where the ray from v towards `target` leaves v's star, by exact predicates. Looks first in the
/// triangle of `start`, a side that starts at v, and turns from there.
/// Requires: target differs from v's position. Cost: the vertex's degree at most.
Departure leave(const Tin& tin, VertexId v, Point2 target, Side start);

/// What lies at a plan position.
struct Location {
    enum class Kind : std::uint8_t { InTriangle, OnEdge, OnVertex, Outside };
    Kind kind = Kind::Outside;
    Side side;        ///< InTriangle: side 0 of it. OnEdge: the edge's lower side.
    VertexId vertex;  ///< OnVertex
};

/// Walks straight from the seed triangle to the position; where the way leaves the mesh (concave
/// outline, holes, other components) goes on from the boundary next to the position. The answer
/// does not depend on the seed. Source: Stanchev & Paraskevov 2023, section 3.2; the seed point is
/// a vertex, which keeps every step exact.
/// Cost: O(1) from `tin.hint(p)`, O(sqrt n) from afar.
Location locate(const Tin& tin, Point2 p, TriangleId seed);

}  // namespace tinsmith::core
