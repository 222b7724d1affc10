// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/mesh/tin.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// Elevation on the triangle's plane at a position in the closed triangle: a convex combination of
/// the corners' elevations, so rounding never leaves their range. Session unit.
double elevation_in(const Tin& tin, TriangleId t, Point2 p);

/// Elevation on the edge at the position of it that is nearest to p, by linear interpolation from
/// the nearer end; the same from either side and direction.
double elevation_on(const Tin& tin, Side s, Point2 p);

/// The triangle's steepest slope, as rise over run.
double steepest_slope(Point3 a, Point3 b, Point3 c);

/// sin^2 of the triangle's smallest angle in 3D: the same value whatever the order of the corners,
/// growing with the angle from 0 to 3/4 (60 degrees).
double smallest_angle_measure(Point3 a, Point3 b, Point3 c);
/// The angle of a measure, in degrees.
double angle_degrees(double measure);

/// Square of the triangle's shortest height by its longest edge, in 3D: the same value whatever the
/// order of the corners, growing with the triangle's quality from 0 to 3/4 (equilateral).
double aspect_measure(Point3 a, Point3 b, Point3 c);

}  // namespace tinsmith::core
