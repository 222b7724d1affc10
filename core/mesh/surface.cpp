// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/predicates/orientation.hpp"
#include "core/types/chosen.hpp"

namespace tinsmith::core {

double elevation_in(const Tin& tin, TriangleId t, Point2 p) {
    const auto& [v0, v1, v2] = tin.triangle(t).vertices;
    const Tin::Vertex& a = tin.vertex(v0);
    const Tin::Vertex& b = tin.vertex(v1);
    const Tin::Vertex& c = tin.vertex(v2);
    // A needle's areas are all cancellation: what a plain determinant leaves there would move z.
    const double wa = compensated_doubled_area(b.plan(), c.plan(), p);
    const double wb = compensated_doubled_area(c.plan(), a.plan(), p);
    const double wc = compensated_doubled_area(a.plan(), b.plan(), p);
    const double sum = wa + wb + wc;
    // From the lowest corner up: weights of differences lose nothing to a large common elevation.
    const double base = std::min({a.z, b.z, c.z});
    const double z = base + (wa * (a.z - base) + wb * (b.z - base) + wc * (c.z - base)) / sum;
    return std::clamp(z, base, std::max({a.z, b.z, c.z}));
}

double elevation_on(const Tin& tin, Side s, Point2 p) {
    return elevation_between(tin.vertex(tin.origin(s)), tin.vertex(tin.destination(s)), p);
}

double elevation_between(const Tin::Vertex& from, const Tin::Vertex& to, Point2 p) {
    const double dx = to.x - from.x;
    const double dy = to.y - from.y;
    const double along = (p.x - from.x) * dx + (p.y - from.y) * dy;
    const double left = (to.x - p.x) * dx + (to.y - p.y) * dy;
    // From the nearer end; in the middle from the one that comes first in plan. Chosen, not
    // branched for: which it is cannot be foreseen.
    bool is_turned = left < along;
    if (left == along) [[unlikely]]
        is_turned = to.x < from.x || (to.x == from.x && to.y < from.y);
    const double near_z = chosen(is_turned, to.z, from.z);
    const double far_z = chosen(is_turned, from.z, to.z);
    const double z = near_z + (far_z - near_z) * (std::min(left, along) / (along + left));
    return std::clamp(z, std::min(near_z, far_z), std::max(near_z, far_z));
}

namespace {

/// Takes the corners in order of their coordinates, so that the sums round the same way for the
/// same triangle.
TriangleShape shape_in_any_order(Point3 a, Point3 b, Point3 c) {
    const auto before = [](const Point3& p, const Point3& q) {
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
    };
    if (before(b, a)) std::swap(a, b);
    if (before(c, b)) std::swap(b, c);
    if (before(b, a)) std::swap(a, b);
    return {a, b, c};
}

}  // namespace

double steepest_slope(Point3 a, Point3 b, Point3 c) {
    return std::sqrt(TriangleShape(a, b, c).squared_slope());
}

double smallest_angle_measure(Point3 a, Point3 b, Point3 c) {
    return shape_in_any_order(a, b, c).smallest_angle_measure();
}

double aspect_measure(Point3 a, Point3 b, Point3 c) {
    return shape_in_any_order(a, b, c).aspect_measure();
}

double angle_degrees(double measure) {
    const double sine = std::sqrt(std::clamp(measure, 0.0, 1.0));
    return std::asin(sine) * (180.0 / 3.14159265358979323846);
}

}  // namespace tinsmith::core
