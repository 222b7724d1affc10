// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/types/point.hpp"

namespace tinsmith::core {

/// A plane that is not upright, in the session's unit.
struct Plane {
    Point3 at;
    double per_x = 0.0;  ///< rise for each unit of x
    double per_y = 0.0;  ///< rise for each unit of y

    double elevation(Point2 p) const {
        return at.z + (per_x * (p.x - at.x) + per_y * (p.y - at.y));
    }
};

Plane level_plane(double elevation);
/// The plane through three points; nothing where they are in one line in plan.
std::optional<Plane> plane_through(Point3 a, Point3 b, Point3 c);
/// The plane through a point that rises towards the azimuth by `slope`: rise over run, 0.02 for
/// 2 %; negative where it falls. The azimuth is in degrees clockwise from +y; at whole multiples of
/// 90 nothing is lost to rounding.
Plane sloping_plane(double slope, double azimuth_degrees, Point3 point);

}  // namespace tinsmith::core
