// SPDX-License-Identifier: Apache-2.0
#include "core/edit/plane.hpp"

#include <cmath>

#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

Plane level_plane(double elevation) {
    return {{0.0, 0.0, elevation}, 0.0, 0.0};
}

std::optional<Plane> plane_through(Point3 a, Point3 b, Point3 c) {
    const double area = doubled_area(a.plan(), b.plan(), c.plan());
    if (area == 0.0) return std::nullopt;
    const double bx = b.x - a.x, by = b.y - a.y, bz = b.z - a.z;
    const double cx = c.x - a.x, cy = c.y - a.y, cz = c.z - a.z;
    return Plane{a, (bz * cy - cz * by) / area, (cz * bx - bz * cx) / area};
}

Plane sloping_plane(double slope, double azimuth_degrees, Point3 point) {
    // Within a quarter turn, so that east and north are 1 and 0 exactly.
    const double turns = std::remainder(azimuth_degrees, 360.0);
    const double quarter = std::nearbyint(turns / 90.0);
    const double angle = (turns - quarter * 90.0) * (3.14159265358979323846 / 180.0);
    const double sine = std::sin(angle), cosine = std::cos(angle);
    double east = sine, north = cosine;
    switch (static_cast<int>(quarter)) {
        case 1:
            east = cosine, north = -sine;
            break;
        case -1:
            east = -cosine, north = sine;
            break;
        case 2:
        case -2:
            east = -sine, north = -cosine;
            break;
        default:
            break;
    }
    return {point, slope * east, slope * north};
}

}  // namespace tinsmith::core
