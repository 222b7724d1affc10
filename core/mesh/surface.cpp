// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

double elevation_in(const Tin& tin, TriangleId t, Point2 p) {
    const auto& [v0, v1, v2] = tin.triangle(t).vertices;
    const Tin::Vertex& a = tin.vertex(v0);
    const Tin::Vertex& b = tin.vertex(v1);
    const Tin::Vertex& c = tin.vertex(v2);
    const double wa = doubled_area(b.plan(), c.plan(), p);
    const double wb = doubled_area(c.plan(), a.plan(), p);
    const double wc = doubled_area(a.plan(), b.plan(), p);
    const double sum = wa + wb + wc;
    // From the lowest corner up: weights of differences lose nothing to a large common elevation.
    const double base = std::min({a.z, b.z, c.z});
    const double z = base + (wa * (a.z - base) + wb * (b.z - base) + wc * (c.z - base)) / sum;
    return std::clamp(z, base, std::max({a.z, b.z, c.z}));
}

double elevation_on(const Tin& tin, Side s, Point2 p) {
    const Tin::Vertex* a = &tin.vertex(tin.origin(s));
    const Tin::Vertex* b = &tin.vertex(tin.destination(s));
    const double dx = b->x - a->x;
    const double dy = b->y - a->y;
    double from_a = (p.x - a->x) * dx + (p.y - a->y) * dy;
    double from_b = (b->x - p.x) * dx + (b->y - p.y) * dy;
    const bool swap =
        from_b < from_a || (from_a == from_b && (b->x < a->x || (b->x == a->x && b->y < a->y)));
    if (swap) {
        std::swap(a, b);
        std::swap(from_a, from_b);
    }
    const double z = a->z + (b->z - a->z) * (from_a / (from_a + from_b));
    return std::clamp(z, std::min(a->z, b->z), std::max(a->z, b->z));
}

double steepest_slope(Point3 a, Point3 b, Point3 c) {
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const double area = doubled_area(a.plan(), b.plan(), c.plan());
    const double nx = uy * vz - uz * vy;
    const double ny = uz * vx - ux * vz;
    return std::sqrt(nx * nx + ny * ny) / area;
}

namespace {

struct SquaredSizes {
    double doubled_area;
    double shortest, middle, longest;  ///< edges
};

/// The same values whatever the order of the corners.
SquaredSizes squared_sizes(Point3 a, Point3 b, Point3 c) {
    const auto squared = [](const Point3& p, const Point3& q) {
        const double dx = p.x - q.x, dy = p.y - q.y, dz = p.z - q.z;
        return dx * dx + dy * dy + dz * dz;
    };
    // Corners by coordinates, so that the sums below round the same way for the same triangle.
    const auto before = [](const Point3& p, const Point3& q) {
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
    };
    if (before(b, a)) std::swap(a, b);
    if (before(c, b)) std::swap(b, c);
    if (before(b, a)) std::swap(a, b);

    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const double nx = uy * vz - uz * vy;
    const double ny = uz * vx - ux * vz;
    const double nz = ux * vy - uy * vx;
    double first = squared(a, b), second = squared(b, c), third = squared(c, a);
    if (first > third) std::swap(first, third);
    if (first > second) std::swap(first, second);
    if (second > third) std::swap(second, third);
    return {nx * nx + ny * ny + nz * nz, first, second, third};
}

}  // namespace

double smallest_angle_measure(Point3 a, Point3 b, Point3 c) {
    const SquaredSizes squared = squared_sizes(a, b, c);
    // The smallest angle lies between the two longest edges.
    const double product = squared.middle * squared.longest;
    return product > 0.0 ? squared.doubled_area / product : 0.0;
}

double aspect_measure(Point3 a, Point3 b, Point3 c) {
    const SquaredSizes squared = squared_sizes(a, b, c);
    const double product = squared.longest * squared.longest;
    return product > 0.0 ? squared.doubled_area / product : 0.0;
}

double angle_degrees(double measure) {
    const double sine = std::sqrt(std::clamp(measure, 0.0, 1.0));
    return std::asin(sine) * (180.0 / 3.14159265358979323846);
}

}  // namespace tinsmith::core
