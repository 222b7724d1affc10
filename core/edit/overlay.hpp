// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/types/point.hpp"

namespace tinsmith::core {

using Triangle2 = std::array<Point2, 3>;

/// Whether two triangles have an inner point in common: exact. Requires: counter-clockwise.
bool overlap(const Triangle2& a, const Triangle2& b);

/// A convex polygon of few corners, counter-clockwise.
struct ConvexPiece {
    static constexpr std::size_t kMost = 9;  ///< each of three cuts adds at most one, with room
    std::array<Point2, kMost> corners;
    std::size_t size = 0;
};

/// What two triangles have in common, relative to the first corner of `a`, so that no large common
/// coordinate takes digits: corners right to rounding of the pieces' size; may be empty or flat
/// where little is in common. Requires: counter-clockwise.
ConvexPiece common_part(const Triangle2& a, const Triangle2& b);

}  // namespace tinsmith::core
