// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "core/predicates/orientation.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// Distance in plan, right to rounding.
inline double distance_between(Point2 p, Point2 q) {
    return std::sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y));
}

/// Distance of p from the closed segment a-b, right to rounding even where p is almost on it.
inline double distance_to_segment(Point2 p, Point2 a, Point2 b) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double ahead = (p.x - a.x) * dx + (p.y - a.y) * dy;
    const double squared = dx * dx + dy * dy;
    if (ahead <= 0.0) return distance_between(p, a);
    if (ahead >= squared) return distance_between(p, b);
    return std::fabs(compensated_doubled_area(a, b, p)) / std::sqrt(squared);
}

/// Whether the segments a-b and c-d meet in one inner point of both. Exact.
inline bool cross_properly(Point2 a, Point2 b, Point2 c, Point2 d) {
    const auto parts = [](Orientation l, Orientation r) {
        return static_cast<int>(l) * static_cast<int>(r) < 0;
    };
    return parts(orientation(a, b, c), orientation(a, b, d)) &&
           parts(orientation(c, d, a), orientation(c, d, b));
}

/// How far along a-b, from 0 to 1, the line through c and d crosses it. Requires: `cross_properly`.
inline double crossing_share(Point2 a, Point2 b, Point2 c, Point2 d) {
    const double to_a = std::fabs(detail::accurate_doubled_area(c, d, a));
    const double to_b = std::fabs(detail::accurate_doubled_area(c, d, b));
    return to_a / (to_a + to_b);
}

}  // namespace tinsmith::core
