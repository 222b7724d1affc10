// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "core/types/point.hpp"

namespace tinsmith::core {

/// On which side of the directed line a -> b the point c lies, in plan.
enum class Orientation : signed char {
    Clockwise = -1,       ///< c is to the right
    Collinear = 0,        ///< c is on the line, exactly
    CounterClockwise = 1  ///< c is to the left
};

namespace detail {
/// The exact answer, whatever the coordinates. About a hundred times the filter's cost.
Orientation exact_orientation(Point2 a, Point2 b, Point2 c);
double accurate_doubled_area(Point2 a, Point2 b, Point2 c);

/// Forward error of the plain determinant relative to the sum of its products' magnitudes:
/// (3 + 16 u) u with u = 2^-53 (Shewchuk 1997).
inline constexpr double kOrientationError = 3.3306690738754716e-16;
/// A plain determinant below this share of that sum may be off by more than 2^-37 of itself.
inline constexpr double kAreaDoubt = 4.5e-5;  // kOrientationError / 2^-37
}  // namespace detail

/// Exact orientation. Laws, on all coordinates within the core's range:
///   1. rotating a, b, c keeps the answer; exchanging two of them reverses it;
///   2. Collinear exactly when the real-number determinant is zero;
///   3. the same answer on every compiler (-ffp-contract=off).
/// Cost: 7 operations and a comparison where the filter decides.
inline Orientation orientation(Point2 a, Point2 b, Point2 c) {
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double determinant = left - right;
    const double bound = detail::kOrientationError * (std::fabs(left) + std::fabs(right));
    if (determinant > bound) return Orientation::CounterClockwise;
    if (-determinant > bound) return Orientation::Clockwise;
    return detail::exact_orientation(a, b, c);
}

inline bool is_left(Point2 a, Point2 b, Point2 c) {
    return orientation(a, b, c) == Orientation::CounterClockwise;
}

/// Twice the signed area of the triangle a, b, c, in square units, right to 2^-36 of itself: the
/// sign is exact and zero means zero. For weights and lengths; never for a decision that an
/// enum can make.
inline double doubled_area(Point2 a, Point2 b, Point2 c) {
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double determinant = left - right;
    if (std::fabs(determinant) > detail::kAreaDoubt * (std::fabs(left) + std::fabs(right)))
        return determinant;
    return detail::accurate_doubled_area(a, b, c);
}

/// Twice the signed area by the plain determinant, and a bound on its absolute error.
struct AreaEstimate {
    double value;
    double error;
};

inline AreaEstimate estimate_doubled_area(Point2 a, Point2 b, Point2 c) {
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    return {left - right, detail::kOrientationError * (std::fabs(left) + std::fabs(right))};
}

/// Twice the signed area for points almost on one line, where the plain determinant is all
/// cancellation: its error is about 2^-104 of the products' magnitudes. For measuring only.
double compensated_doubled_area(Point2 a, Point2 b, Point2 c);

/// True where c, known to lie on the line through a and b, lies strictly ahead of a towards b.
/// Comparisons only, so exact. Requires: a != b.
inline bool is_ahead(Point2 a, Point2 b, Point2 c) {
    if (a.x < b.x) return c.x > a.x;
    if (a.x > b.x) return c.x < a.x;
    return a.y < b.y ? c.y > a.y : c.y < a.y;
}

}  // namespace tinsmith::core
