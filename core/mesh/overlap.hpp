// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/mesh/tin.hpp"

namespace tinsmith::core {

/// A place at which a mesh is no function of plan.
struct Overlap {
    Point2 place;
    TriangleId triangle;  ///< that is covered by another; invalid: two elevations at one place
    VertexId vertex;      ///< the later one of two at one place; invalid where a triangle is told
};

/// Where a mesh lies over itself, or has two elevations in one place; empty: nowhere.
///
/// Requires laws 1 to 3 of the mesh and that no fan of triangles overlaps itself. Then the number
/// of triangles over a place is how often the boundary winds around it, and only the boundary has
/// to be looked at: a line is swept over its edges, by exact predicates alone. Edges may touch one
/// another and lie along one another, as where two parts meet or a slit was cut.
///
/// Places with two elevations are told, at most `most`, up to the first from the west that is
/// covered twice, which is told last: beyond it nothing is certain.
/// Cost: O(b log b) for b edges of the boundary, and one pass over the triangles.
std::vector<Overlap> find_overlaps(const Tin& tin, std::size_t most);

}  // namespace tinsmith::core
