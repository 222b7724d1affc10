// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tinsmith::core {

/// A plan position: easting x and northing y, in the session's length unit.
struct Point2 {
    double x = 0.0;
    double y = 0.0;

    friend bool operator==(const Point2&, const Point2&) = default;
};

/// A plan position with its elevation z, all in the session's length unit.
struct Point3 {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;

    Point2 plan() const { return {x, y}; }

    friend bool operator==(const Point3&, const Point3&) = default;
};

}  // namespace tinsmith::core
