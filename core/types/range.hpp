// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace tinsmith::core {

/// Coordinates the core accepts: zero, or a magnitude between floor and limit. Within these bounds
/// no product in an exact predicate can overflow or lose bits to underflow.
inline constexpr double kCoordinateLimit = 1e15;
inline constexpr double kCoordinateFloor = 1e-60;

inline bool in_coordinate_range(double value) {
    const double magnitude = std::fabs(value);
    return value == 0.0 || (magnitude >= kCoordinateFloor && magnitude <= kCoordinateLimit);
}

}  // namespace tinsmith::core
