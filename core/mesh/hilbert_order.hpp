// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/types/point.hpp"

namespace tinsmith::core {

/// The given points, by index, along a Hilbert curve over their box in plan: what is near in the
/// order is near in plan. Where many points share a cell of the curve, it goes through that cell
/// again on a finer scale. Points of one position stand side by side, by index. The same on every
/// compiler. Requires: indices that rise; coordinates in the core's range; fewer than 2^32 points.
/// Cost: linear where points are spread, n log n at worst.
std::vector<std::uint32_t> hilbert_order(std::span<const Point3> points,
                                         std::span<const std::uint32_t> those);
/// The same for all points.
std::vector<std::uint32_t> hilbert_order(std::span<const Point3> points);

}  // namespace tinsmith::core
