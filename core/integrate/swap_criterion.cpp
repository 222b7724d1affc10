// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/swap_criterion.hpp"

#include <algorithm>
#include <cmath>

#include "core/mesh/surface.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/ulp.hpp"

namespace tinsmith::core {

namespace {

struct Vector {
    double x, y, z;
};

Vector from_to(const Point3& p, const Point3& q) {
    return {q.x - p.x, q.y - p.y, q.z - p.z};
}

Vector cross(const Vector& u, const Vector& v) {
    return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

double dot(const Vector& u, const Vector& v) {
    return u.x * v.x + u.y * v.y + u.z * v.z;
}

/// Whether the corners lie in one plane as far as their elevations, rounded to doubles, can tell.
bool is_flat(const SwapQuad& quad) {
    const auto& [a, b, c, d] = quad;
    const Vector ab = from_to(a, b), ac = from_to(a, c), ad = from_to(a, d);
    const Vector plus{ab.x * ac.y * ad.z, ab.y * ac.z * ad.x, ab.z * ac.x * ad.y};
    const Vector minus{ab.x * ac.z * ad.y, ab.y * ac.x * ad.z, ab.z * ac.y * ad.x};
    const double volume = (plus.x - minus.x) + (plus.y - minus.y) + (plus.z - minus.z);
    const double sum = std::fabs(plus.x) + std::fabs(plus.y) + std::fabs(plus.z) +
                       std::fabs(minus.x) + std::fabs(minus.y) + std::fabs(minus.z);
    // Three differences, two products and up to three sums: below 10 roundings each.
    constexpr double kRounding = 0x1p-49;
    // Six times the volume is the plan area of the parallelogram on the diagonals times the
    // vertical distance of these. That is known to a few ulps, for each elevation was computed.
    const double highest =
        std::max({std::fabs(a.z), std::fabs(b.z), std::fabs(c.z), std::fabs(d.z)});
    const double area = std::fabs(ab.x * (c.y - d.y) - ab.y * (c.x - d.x));
    return std::fabs(volume) <= kRounding * sum + 4.0 * ulp(highest) * area;
}

}  // namespace

SwapQuad quad_around(const Tin& tin, Side s) {
    return {tin.vertex(tin.origin(s)).point(), tin.vertex(tin.destination(s)).point(),
            tin.vertex(tin.apex(s)).point(), tin.vertex(tin.apex(tin.twin(s))).point()};
}

bool can_swap(const SwapQuad& quad) {
    const auto& [a, b, c, d] = quad;
    return is_left(a.plan(), d.plan(), c.plan()) && is_left(d.plan(), b.plan(), c.plan());
}

bool improves_aspect(const SwapQuad& quad) {
    const auto& [a, b, c, d] = quad;
    const double now = std::min(aspect_measure(a, b, c), aspect_measure(b, a, d));
    return aspect_measure(a, d, c) > now && aspect_measure(d, b, c) > now;
}

// With normals m and n of the triangles beside an edge e, |m x n| = |e| * 6 V, where V is the
// volume of the tetrahedron a b c d: the same for both diagonals. So the cotangent of the angle
// between the normals is m . n / (|e| * 6 V), and V need not be known to compare two of them.
bool bends_no_more(const SwapQuad& quad) {
    const auto& [a, b, c, d] = quad;
    if (is_flat(quad)) return true;
    const Vector ab = from_to(a, b), ac = from_to(a, c), ad = from_to(a, d);
    const Vector dc = from_to(d, c), db = from_to(d, b);
    const double now = dot(cross(ab, ac), cross(ad, ab));
    const double then = dot(cross(ad, ac), cross(db, dc));
    return then * std::sqrt(dot(ab, ab)) >= now * std::sqrt(dot(dc, dc));
}

double vertical_gap(const SwapQuad& quad) {
    const auto& [a, b, c, d] = quad;
    const double above_c = doubled_area(a.plan(), b.plan(), c.plan());
    const double above_d = doubled_area(b.plan(), a.plan(), d.plan());
    const double beside_a = doubled_area(a.plan(), d.plan(), c.plan());
    const double beside_b = doubled_area(d.plan(), b.plan(), c.plan());
    // Where the diagonals cross, each is cut in proportion to the areas on either side of the
    // other. From the lowest corner up: nothing is lost to a large common elevation.
    const double low = std::min({a.z, b.z, c.z, d.z});
    const double range = std::max({a.z, b.z, c.z, d.z}) - low;
    const double on_ab = ((a.z - low) * beside_b + (b.z - low) * beside_a) / (beside_a + beside_b);
    const double on_cd = ((c.z - low) * above_d + (d.z - low) * above_c) / (above_c + above_d);
    // Areas are right to 2^-36, so each of the two elevations is to 2^-35 of the range and a few
    // roundings more.
    constexpr double kAllowance = 0x1p-33;
    return std::fabs(on_ab - on_cd) + kAllowance * range;
}

}  // namespace tinsmith::core
