// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/types/point.hpp"

namespace tinsmith::core {

/// Where a point lies against the circle through three others, in plan.
enum class CircleSide : signed char {
    Outside = -1,
    On = 0,  ///< on the circle, exactly
    Inside = 1
};

namespace detail {
/// The exact answer, whatever the coordinates: quick where four points make an upright rectangle or
/// have few bits, as those of grids do; else 20 to 1000 times the filter's cost.
CircleSide exact_in_circle(Point2 a, Point2 b, Point2 c, Point2 d);

/// Forward error of the plain determinant relative to the sum of its products' magnitudes is
/// (10 + 96 u) u with u = 2^-53 (Shewchuk 1997); a little more, for the sum is rounded too.
inline constexpr double kInCircleError = 1.12e-15;
/// What underflow can add to it, within the core's range of coordinates.
inline constexpr double kInCircleUnderflow = 1e-290;
}  // namespace detail

/// Exact: where d lies against the circle through a, b, c, which are counter-clockwise.
/// Laws, on all coordinates within the core's range:
///   1. exchanging two of the four points reverses the answer (a clockwise a, b, c has its inside
///      outside), and so an even permutation keeps it;
///   2. On exactly when the real-number determinant is zero; a tie is the caller's to break;
///   3. the same answer on every compiler (-ffp-contract=off).
/// Cost: 27 operations and a comparison where the filter decides.
inline CircleSide in_circle(Point2 a, Point2 b, Point2 c, Point2 d) {
    const double ax = a.x - d.x, ay = a.y - d.y;
    const double bx = b.x - d.x, by = b.y - d.y;
    const double cx = c.x - d.x, cy = c.y - d.y;
    const double a_square = ax * ax + ay * ay;
    const double b_square = bx * bx + by * by;
    const double c_square = cx * cx + cy * cy;
    const double determinant = a_square * (bx * cy - cx * by) + b_square * (cx * ay - ax * cy) +
                               c_square * (ax * by - bx * ay);
    // |bx cy| + |cx by| is at most the root of b_square c_square (Cauchy), that at most their mean:
    // so this is no less than the products' magnitudes, and needs none of them.
    const double size = a_square * (b_square + c_square) + b_square * c_square;
    const double bound = detail::kInCircleError * size + detail::kInCircleUnderflow;
    if (determinant > bound) return CircleSide::Inside;
    if (-determinant > bound) return CircleSide::Outside;
    return detail::exact_in_circle(a, b, c, d);
}

}  // namespace tinsmith::core
