// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/types/point.hpp"

namespace tinsmith::verify {

using core::Point2;
using core::Point3;

// The arithmetic that decides, written apart from the core's so that the two cannot be wrong
// together: doubles where they suffice, rational numbers (GMP, in exact.cpp alone) where not.

/// Side of the directed line a -> b on which c lies: 1 left, -1 right, 0 on it. Exact.
int side_of(Point2 a, Point2 b, Point2 c);

/// Where d is against the circle through a, b, c, counter-clockwise: 1 inside, -1 outside, 0 on it.
/// Exact, by rational numbers always.
int circle_side_of(Point2 a, Point2 b, Point2 c, Point2 d);

/// Twice the signed area of a, b, c: the sign exact, the value right to 2^-40 of itself.
double doubled_area(Point2 a, Point2 b, Point2 c);

/// Whether p is at most `reach` from the closed segment a-b. Exact.
bool is_within(Point2 p, Point2 a, Point2 b, double reach);

/// Distance of p from the closed segment a-b, right to about 2^-38 of itself.
double distance_to(Point2 p, Point2 a, Point2 b);

/// Whether the segments a-b and c-d meet in one inner point of both. Exact.
bool cross_properly(Point2 a, Point2 b, Point2 c, Point2 d);

/// Where they do, right to about 2^-50 of the length of a-b along a-b. Requires: cross_properly.
Point2 crossing_point(Point2 a, Point2 b, Point2 c, Point2 d);

/// Vertical distance of a-b and c-d where they cross in plan, as a number for reports; and whether
/// it is at most `bound`, exactly. Requires: cross_properly.
double gap_at_crossing(Point3 a, Point3 b, Point3 c, Point3 d);
bool gap_at_crossing_within(Point3 a, Point3 b, Point3 c, Point3 d, double bound);

/// Vertical distance of p from the plane of a, b, c, likewise. Requires: a, b, c is not flat in
/// plan and p lies in it, or so close that the weights of the corners stay small.
double gap_to_plane(Point3 p, Point3 a, Point3 b, Point3 c);
bool gap_to_plane_within(Point3 p, Point3 a, Point3 b, Point3 c, double bound);

/// How often rational numbers had to decide in this thread so far; for the tuning of filters.
unsigned long long rational_decisions();

}  // namespace tinsmith::verify
