// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/mesh/growing_delaunay.hpp"
#include "core/mesh/insertion_order.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// Two Delaunay triangulations whose points a line across the axis parts, none on it, side by side
/// in one array that has two slots more.
struct DelaunayHalves {
    std::span<const Point2> points;                  ///< of both
    std::span<GrowingDelaunay::Triangle> triangles;  ///< lower, higher, two free ones
    std::size_t lower_end;                           ///< where the higher ones begin
    PlanAxis axis;
};

/// Makes them one: fills the gap between their hulls with triangles, in the slots of the ghosts
/// that go, and swaps from there until no vertex is in any circle, exactly (Lawson 1977). Of four
/// points on a circle that diagonal stays that was there first, so that nothing but the halves
/// decides.
/// False where that takes more than `most_swaps`, as for points that lie in long rows beside the
/// line: what is in the array then is of no use. Cost: the hulls' lengths, and the swaps.
bool join(const DelaunayHalves& halves, std::size_t most_swaps);

}  // namespace tinsmith::core
