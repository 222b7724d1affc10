// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/mesh/tin.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// Two triangles and the edge between them, which may be swapped.
//
//          c                 the edge a -> b has T = (a, b, c) on its left and
//         / \                U = (b, a, d) on its right; swapped, they are
//       a --- b              (a, d, c) and (d, b, c)
//         \ /
//          d
struct SwapQuad {
    Point3 a;
    Point3 b;
    Point3 c;
    Point3 d;
};

/// The quad around the edge. Requires: not a boundary edge.
SwapQuad quad_around(const Tin& tin, Side s);

/// Whether both triangles are strictly positive in plan after the swap. Exact.
bool can_swap(const SwapQuad& quad);

/// Whether the worse of the two triangles' aspects (longest edge by shortest height, in 3D) gets
/// strictly better. Aspects are compared as `aspect_measure` rounds them, so a chain of such swaps
/// never comes back to where it was.
bool improves_aspect(const SwapQuad& quad);

/// Whether the surface bends along the new diagonal no more than it did along the old one: the
/// angle between the two triangles' normals does not grow. Four corners that lie in one plane as
/// far as their rounded elevations can tell are flat before and after.
bool bends_no_more(const SwapQuad& quad);

/// How far the swap moves the surface vertically: the distance of the diagonals where they cross
/// in plan, which is where the two surfaces differ most. Never less than the true distance, and
/// more by at most 2^-32 of the range of the corners' elevations. Requires: `can_swap`.
double vertical_gap(const SwapQuad& quad);

}  // namespace tinsmith::core
