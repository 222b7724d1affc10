// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "core/mesh/tin.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// Elevation on the triangle's plane at a position in the closed triangle: a convex combination of
/// the corners' elevations, so rounding never leaves their range. Session unit.
double elevation_in(const Tin& tin, TriangleId t, Point2 p);

/// Elevation on the edge at the position of it that is nearest to p, by linear interpolation from
/// the nearer end; the same from either side and direction.
double elevation_on(const Tin& tin, Side s, Point2 p);
double elevation_between(const Tin::Vertex& from, const Tin::Vertex& to, Point2 p);

/// What a triangle in 3D is like. The order of the corners shows in the last digits alone.
class TriangleShape {
  public:
    TriangleShape(Point3 a, Point3 b, Point3 c) {
        const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
        const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
        const double wx = c.x - b.x, wy = c.y - b.y, wz = c.z - b.z;
        const double nx = uy * vz - uz * vy;
        const double ny = uz * vx - ux * vz;
        const double nz = doubled_area(b.plan(), c.plan(), a.plan());
        level_squared_ = nx * nx + ny * ny;
        upright_squared_ = nz * nz;
        const double ab = ux * ux + uy * uy + uz * uz;
        const double ac = vx * vx + vy * vy + vz * vz;
        const double bc = wx * wx + wy * wy + wz * wz;
        longest_ = std::max(std::max(ab, ac), bc);
        middle_ = std::max(std::min(ab, ac), std::min(std::max(ab, ac), bc));
    }

    /// sin^2 of the smallest angle: grows with it from 0 to 3/4 (60 degrees).
    double smallest_angle_measure() const {
        // The smallest angle lies between the two longest edges.
        const double product = longest_ * middle_;
        return product > 0.0 ? (level_squared_ + upright_squared_) / product : 0.0;
    }
    /// Whether the measure of the smallest angle is below the bound, to within its last digits.
    bool has_angle_below(double bound) const {
        return level_squared_ + upright_squared_ <= bound * (longest_ * middle_);
    }
    /// Square of the shortest height by the longest edge: from 0 to 3/4 (equilateral).
    double aspect_measure() const {
        const double product = longest_ * longest_;
        return product > 0.0 ? (level_squared_ + upright_squared_) / product : 0.0;
    }
    /// Square of the steepest slope, as rise over run.
    double squared_slope() const { return level_squared_ / upright_squared_; }
    bool is_steeper_than(double squared_slope) const {
        return level_squared_ > squared_slope * upright_squared_;
    }

  private:
    double level_squared_;    ///< of the normal that is as long as twice the area
    double upright_squared_;  ///< of its vertical part
    double longest_;          ///< edge, squared
    double middle_;
};

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
