// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/integrate/report.hpp"
#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "core/regions/constraint_history.hpp"

namespace tinsmith::core {

/// What is inside where a shape's closed paths overlap themselves or one another.
enum class Winding {
    EvenOdd,  ///< what an odd number of crossings separates from the outside: holes by nesting
    NonZero,  ///< what the paths run around, on balance: holes run the other way round
};

/// A shape as integrating it reported it: all that finding its region needs, to be kept with it.
/// A view; what it names must live longer.
struct Outline {
    const Shape& shape;
    std::span<const Chain> chains;
    std::span<const OutsidePart> outside;
};

/// The part of a mesh inside a shape.
struct Region {
    std::vector<TriangleId> triangles;  ///< in order of slot
    double plan_area = 0.0;             ///< square units of the session, right to 1e-10 of itself
    double surface_area = 0.0;          ///< the same along the slopes
};

/// The triangles inside the shape's closed paths; open paths enclose nothing. Each triangle is
/// inside or outside as a whole, for no chain runs through one.
///
/// Laws: the lines that decide are the chains, vertex by vertex, and the input where it is outside
/// the mesh. So the answer is exact for the mesh as it is, however far snapping moved the chains;
/// swaps inside facets and later splits change its triangles, never its area beyond rounding.
/// Where the mesh is narrower than the snap, a path that passes it need not cut it: what lies there
/// is inside or outside as the largest triangle at the chain is.
/// Requires: the history is of `tin` as it is now; see `ConstraintHistory::expand` for the chains.
/// Cost: the chains with the triangles around them, and the region; nothing for what is outside.
/// Memory: a few bytes for each triangle at the chains, a bit for each of the region, in pages.
Region find_region(const Tin& tin, const ConstraintHistory& history, const Outline& outline,
                   Winding winding);

}  // namespace tinsmith::core
