// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types/executor.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// The plan's axis along which points are parted.
enum class PlanAxis : std::uint8_t { East, North };

inline double along(PlanAxis axis, Point2 p) {
    return axis == PlanAxis::East ? p.x : p.y;
}

/// A point at the position of an earlier one, the first there.
struct Repeated {
    std::uint32_t later;
    std::uint32_t first;
};

/// In what order points are to be inserted into a triangulation.
struct InsertionOrder {
    std::vector<std::uint32_t> points;  ///< by index, each position once, along a Hilbert curve
    std::size_t middle = 0;             ///< where the second of two parts begins; zero: one part
    PlanAxis axis = PlanAxis::East;     ///< along which those of the second are farther
    std::vector<Repeated> repeated;     ///< by the later one's index
};

/// Requires: as `hilbert_order`. `in_parts`: in two, by a line across the points' longer extent,
/// near their median there; the second part is empty where they are all on that line. Cost: linear
/// where points are spread.
InsertionOrder insertion_order(std::span<const Point3> points, bool in_parts,
                               const Executor& executor);

/// Rounds of growing numbers of points, each spread over all of the plan and in the curve's order:
/// then no order of the input makes insertions dear (Amenta, Choi, Rote 2003). Lots are drawn by
/// the points' indices.
void draw_lots(std::span<std::uint32_t> order);

}  // namespace tinsmith::core
