// SPDX-License-Identifier: Apache-2.0
#include "tests/verify/exact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gmpxx.h>

namespace tinsmith::verify {

namespace {

thread_local unsigned long long rational_count = 0;

using Rational = mpq_class;

struct RationalPoint {
    Rational x, y;
};

RationalPoint rational(Point2 p) {
    return {Rational(p.x), Rational(p.y)};
}

Rational rational_area(Point2 a, Point2 b, Point2 c) {
    ++rational_count;
    const RationalPoint p = rational(a), q = rational(b), r = rational(c);
    return (p.x - r.x) * (q.y - r.y) - (p.y - r.y) * (q.x - r.x);
}

/// x - y as a rounded difference and what rounding took from it, exactly (Knuth).
struct Difference {
    double high;
    double low;
    Difference(double x, double y) : high(x - y) {
        const double y_seen = x - high;
        low = (x - (high + y_seen)) + (y_seen - y);
    }
};

/// A product of two differences, to 2^-104 of itself.
struct Product {
    double high;
    double low;
    Product(Difference x, Difference y)
        : high(x.high * y.high),
          low(std::fma(x.high, y.high, -high) + (x.high * y.low + x.low * y.high)) {}
};

constexpr double two_to(int exponent) {
    double power = 1.0;
    for (int i = 0; i > exponent; --i)
        power /= 2;
    return power;
}

/// The area with an error below `error` times `size`.
struct Area {
    double value;
    double size;
    bool exact;  ///< the sign of value is the sign of the area
};

Area accurate_area(Point2 a, Point2 b, Point2 c) {
    const Difference ax(a.x, c.x), by(b.y, c.y), ay(a.y, c.y), bx(b.x, c.x);
    const Product left(ax, by), right(ay, bx);
    const double value = (left.high - right.high) + (left.low - right.low);
    const double size = std::fabs(left.high) + std::fabs(right.high);
    // Four exact differences make the two products exact, so that equal halves mean equal.
    const bool exact = ax.low == 0 && by.low == 0 && ay.low == 0 && bx.low == 0 && size > 1e-250 &&
                       left.high == right.high;
    const bool zero = (ax.high == 0 || by.high == 0) && (ay.high == 0 || bx.high == 0);
    return {value, size, exact || zero};
}

/// An area as gaps want it: the value right to `error` of itself.
struct Weight {
    double value;
    double error;
};

Weight weight(Point2 a, Point2 b, Point2 c) {
    const Area area = accurate_area(a, b, c);
    if (area.exact) return {area.value, two_to(-53)};
    const double error = two_to(-102) * area.size / std::fabs(area.value) + two_to(-53);
    if (error < two_to(-48) && area.size > 1e-250) return {area.value, error};
    return {rational_area(a, b, c).get_d(), two_to(-53)};
}

/// A vertical distance and how much it may be wrong.
struct Gap {
    double value;
    double error;
};

Gap crossing_gap(Point3 a, Point3 b, Point3 c, Point3 d) {
    const Weight ea = weight(c.plan(), d.plan(), a.plan());
    const Weight eb = weight(c.plan(), d.plan(), b.plan());
    const Weight ec = weight(a.plan(), b.plan(), c.plan());
    const Weight ed = weight(a.plan(), b.plan(), d.plan());
    const double rise = ea.value / (ea.value - eb.value) * (b.z - a.z);
    const double other = ec.value / (ec.value - ed.value) * (d.z - c.z);
    const double error = (ea.error + eb.error + two_to(-51)) * std::fabs(rise) +
                         (ec.error + ed.error + two_to(-51)) * std::fabs(other) +
                         two_to(-52) * std::fabs(a.z - c.z);
    return {std::fabs((a.z - c.z) + (rise - other)), error};
}

Gap plane_gap(Point3 p, Point3 a, Point3 b, Point3 c) {
    const Weight all = weight(a.plan(), b.plan(), c.plan());
    const Weight wb = weight(c.plan(), a.plan(), p.plan());
    const Weight wc = weight(a.plan(), b.plan(), p.plan());
    const double to_b = wb.value / all.value * (b.z - a.z);
    const double to_c = wc.value / all.value * (c.z - a.z);
    const double error = (all.error + wb.error + two_to(-51)) * std::fabs(to_b) +
                         (all.error + wc.error + two_to(-51)) * std::fabs(to_c) +
                         two_to(-52) * std::fabs(p.z - a.z);
    return {std::fabs((p.z - a.z) - (to_b + to_c)), error};
}

}  // namespace

unsigned long long rational_decisions() {
    return rational_count;
}

int side_of(Point2 a, Point2 b, Point2 c) {
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double size = std::fabs(left) + std::fabs(right);
    const double value = left - right;
    if (std::fabs(value) > two_to(-51) * size && size > 1e-250) return value > 0 ? 1 : -1;
    const Area area = accurate_area(a, b, c);
    if (area.exact || (std::fabs(area.value) > two_to(-98) * area.size && area.size > 1e-250))
        return area.value > 0 ? 1 : area.value < 0 ? -1 : 0;
    return sgn(rational_area(a, b, c));
}

int circle_side_of(Point2 a, Point2 b, Point2 c, Point2 d) {
    ++rational_count;
    const RationalPoint o = rational(d);
    const auto row = [&o](Point2 p) {
        const RationalPoint q = rational(p);
        return RationalPoint{q.x - o.x, q.y - o.y};
    };
    const RationalPoint p = row(a), q = row(b), r = row(c);
    const auto square = [](const RationalPoint& s) -> Rational { return s.x * s.x + s.y * s.y; };
    const Rational determinant = square(p) * (q.x * r.y - r.x * q.y) +
                                 square(q) * (r.x * p.y - p.x * r.y) +
                                 square(r) * (p.x * q.y - q.x * p.y);
    return sgn(determinant);
}

double doubled_area(Point2 a, Point2 b, Point2 c) {
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double size = std::fabs(left) + std::fabs(right);
    if (std::fabs(left - right) > two_to(-10) * size && size > 1e-250) return left - right;
    const Area area = accurate_area(a, b, c);
    if (area.exact || (std::fabs(area.value) > two_to(-60) * area.size && area.size > 1e-250))
        return area.value;
    return rational_area(a, b, c).get_d();
}

double distance_to(Point2 p, Point2 a, Point2 b) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double along = (p.x - a.x) * dx + (p.y - a.y) * dy;
    const double square = dx * dx + dy * dy;
    if (along <= 0) return std::hypot(p.x - a.x, p.y - a.y);
    if (along >= square) return std::hypot(p.x - b.x, p.y - b.y);
    return std::fabs(doubled_area(a, b, p)) / std::sqrt(square);
}

bool is_within(Point2 p, Point2 a, Point2 b, double reach) {
    const auto [left, right] = std::minmax(a.x, b.x);
    const auto [low, high] = std::minmax(a.y, b.y);
    const double wide = 2 * reach;
    if (p.x < left - wide || p.x > right + wide || p.y < low - wide || p.y > high + wide)
        return false;
    const double distance = distance_to(p, a, b);
    if (std::fabs(distance - reach) > two_to(-36) * reach) return distance < reach;
    ++rational_count;
    const RationalPoint rp = rational(p), ra = rational(a), rb = rational(b);
    const Rational dx = rb.x - ra.x, dy = rb.y - ra.y, px = rp.x - ra.x, py = rp.y - ra.y;
    const Rational along = px * dx + py * dy, square = dx * dx + dy * dy;
    const Rational limit = Rational(reach) * Rational(reach);
    if (along <= 0) return px * px + py * py <= limit;
    const Rational qx = rp.x - rb.x, qy = rp.y - rb.y;
    if (along >= square) return qx * qx + qy * qy <= limit;
    const Rational area = dx * py - dy * px;
    return area * area <= limit * square;
}

bool cross_properly(Point2 a, Point2 b, Point2 c, Point2 d) {
    const int at_c = side_of(a, b, c);
    if (at_c == 0 || at_c + side_of(a, b, d) != 0) return false;
    const int at_a = side_of(c, d, a);
    return at_a != 0 && at_a + side_of(c, d, b) == 0;
}

Point2 crossing_point(Point2 a, Point2 b, Point2 c, Point2 d) {
    const double ea = weight(c, d, a).value, eb = weight(c, d, b).value;
    // From the nearer end, so that the rounding of the share counts least.
    const bool from_b = std::fabs(eb) < std::fabs(ea);
    const double share = (from_b ? eb : ea) / (from_b ? eb - ea : ea - eb);
    if (from_b) std::swap(a, b);
    return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
}

double gap_at_crossing(Point3 a, Point3 b, Point3 c, Point3 d) {
    return crossing_gap(a, b, c, d).value;
}

bool gap_at_crossing_within(Point3 a, Point3 b, Point3 c, Point3 d, double bound) {
    const Gap gap = crossing_gap(a, b, c, d);
    if (gap.value + gap.error < bound) return true;
    if (gap.value - gap.error > bound) return false;
    const Rational ea = rational_area(c.plan(), d.plan(), a.plan());
    const Rational eb = rational_area(c.plan(), d.plan(), b.plan());
    const Rational ec = rational_area(a.plan(), b.plan(), c.plan());
    const Rational ed = rational_area(a.plan(), b.plan(), d.plan());
    const Rational za = (ea * Rational(b.z) - eb * Rational(a.z)) / (ea - eb);
    const Rational zc = (ec * Rational(d.z) - ed * Rational(c.z)) / (ec - ed);
    return abs(za - zc) <= Rational(bound);
}

double gap_to_plane(Point3 p, Point3 a, Point3 b, Point3 c) {
    return plane_gap(p, a, b, c).value;
}

bool gap_to_plane_within(Point3 p, Point3 a, Point3 b, Point3 c, double bound) {
    const Gap gap = plane_gap(p, a, b, c);
    if (gap.value + gap.error < bound) return true;
    if (gap.value - gap.error > bound) return false;
    const Rational all = rational_area(a.plan(), b.plan(), c.plan());
    const Rational wb = rational_area(c.plan(), a.plan(), p.plan());
    const Rational wc = rational_area(a.plan(), b.plan(), p.plan());
    const Rational za(a.z);
    const Rational rise = wb * (Rational(b.z) - za) + wc * (Rational(c.z) - za);
    return abs((Rational(p.z) - za) * all - rise) <= Rational(bound) * abs(all);
}

}  // namespace tinsmith::verify
