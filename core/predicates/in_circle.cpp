// SPDX-License-Identifier: Apache-2.0
#include "core/predicates/in_circle.hpp"

#include <cmath>
#include <cstddef>

#include "core/predicates/expansion.hpp"

namespace tinsmith::core::detail {

namespace {

/// A point as seen from the fourth: differences, exact.
struct Seen {
    Exact x;
    Exact y;

    Seen(Point2 p, Point2 from)
        : x(exact_difference(p.x, from.x)), y(exact_difference(p.y, from.y)) {}
    bool is_exact() const { return x.rest == 0.0 && y.rest == 0.0; }
};

/// Whether p-q and r-s are the diagonals of a rectangle with upright sides.
bool are_diagonals(Point2 p, Point2 q, Point2 r, Point2 s) {
    return (r.x == p.x && r.y == q.y && s.x == q.x && s.y == p.y) ||
           (r.x == q.x && r.y == p.y && s.x == p.x && s.y == q.y);
}

/// u v + w z where doubles hold it and both products; else false.
bool is_held(double u, double v, double w, double z, double& sum) {
    const Exact one = exact_product(u, v), other = exact_product(w, z);
    const Exact both = exact_sum(one.value, other.value);
    sum = both.value;
    return one.rest == 0.0 && other.rest == 0.0 && both.rest == 0.0;
}

CircleSide side_of(double x) {
    return x > 0.0 ? CircleSide::Inside : x < 0.0 ? CircleSide::Outside : CircleSide::On;
}

/// The answer where minors and squares are doubles, as for points of a lattice near one another.
bool decides_with_few_bits(const Seen& a, const Seen& b, const Seen& c, CircleSide& side) {
    if (!a.is_exact() || !b.is_exact() || !c.is_exact()) return false;
    const double ax = a.x.value, ay = a.y.value, bx = b.x.value, by = b.y.value, cx = c.x.value,
                 cy = c.y.value;
    double a_square{}, b_square{}, c_square{}, bc{}, ca{}, ab{};
    if (!is_held(ax, ax, ay, ay, a_square) || !is_held(bx, bx, by, by, b_square) ||
        !is_held(cx, cx, cy, cy, c_square) || !is_held(bx, cy, -cx, by, bc) ||
        !is_held(cx, ay, -ax, cy, ca) || !is_held(ax, by, -bx, ay, ab))
        return false;
    Expansion<6> sum;
    sum.add(exact_product(a_square, bc));
    sum.add(exact_product(b_square, ca));
    sum.add(exact_product(c_square, ab));
    side = static_cast<CircleSide>(sum.sign());
    return true;
}

// Arithmetic on pairs of doubles, right to about 2^-102 of the magnitudes that come in.

Exact pair_of(double value, double rest) {
    const double sum = value + rest;
    return {sum, rest - (sum - value)};
}

Exact times(const Exact& u, const Exact& v) {
    const Exact product = exact_product(u.value, v.value);
    return pair_of(product.value, product.rest + (u.value * v.rest + u.rest * v.value));
}

Exact plus(const Exact& u, const Exact& v) {
    const Exact sum = exact_sum(u.value, v.value);
    return pair_of(sum.value, sum.rest + (u.rest + v.rest));
}

Exact minus(const Exact& u, const Exact& v) {
    return plus(u, {-v.value, -v.rest});
}

Exact square(const Seen& p) {
    return plus(times(p.x, p.x), times(p.y, p.y));
}

Exact minor(const Seen& p, const Seen& q) {
    return minus(times(p.x, q.y), times(q.x, p.y));
}

bool decides_in_pairs(const Seen& a, const Seen& b, const Seen& c, CircleSide& side) {
    const Exact a_square = square(a), b_square = square(b), c_square = square(c);
    const Exact sum = plus(plus(times(a_square, minor(b, c)), times(b_square, minor(c, a))),
                           times(c_square, minor(a, b)));
    const double size =
        a_square.value * (b_square.value + c_square.value) + b_square.value * c_square.value;
    // Five roundings on each way, of 2^-102 of the size at most, and room; no word where underflow
    // could have taken bits.
    if (size < 1e-200 || std::fabs(sum.value) <= 0x1p-96 * size) return false;
    side = side_of(sum.value);
    return true;
}

/// u v with its rests, as the exact sum of at most 8 doubles.
template <std::size_t N>
void add_product(Expansion<N>& sum, const Exact& u, const Exact& v, double sign) {
    for (const double p : {u.rest, u.value})
        for (const double q : {v.rest, v.value})
            if (p != 0.0 && q != 0.0) sum.add(exact_product(sign * p, q));
}

Expansion<16> exact_square(const Seen& p) {
    Expansion<16> sum;
    add_product(sum, p.x, p.x, 1.0);
    add_product(sum, p.y, p.y, 1.0);
    return sum;
}

Expansion<16> exact_minor(const Seen& p, const Seen& q) {
    Expansion<16> sum;
    add_product(sum, p.x, q.y, 1.0);
    add_product(sum, q.x, p.y, -1.0);
    return sum;
}

using Whole = Expansion<std::size_t{3} * 16 * 16 * 2>;

void add_product(Whole& sum, const Expansion<16>& u, const Expansion<16>& v) {
    for (std::size_t i = 0; i < u.size(); ++i)
        for (std::size_t k = 0; k < v.size(); ++k)
            sum.add(exact_product(u.part(i), v.part(k)));
}

}  // namespace

CircleSide exact_in_circle(Point2 a, Point2 b, Point2 c, Point2 d) {
    if (are_diagonals(a, b, c, d) || are_diagonals(a, c, b, d) || are_diagonals(a, d, b, c))
        return CircleSide::On;
    const Seen from_a(a, d), from_b(b, d), from_c(c, d);
    CircleSide side{};
    if (decides_with_few_bits(from_a, from_b, from_c, side)) return side;
    if (decides_in_pairs(from_a, from_b, from_c, side)) return side;
    // Nothing underflows: differences are multiples of 2^-252, products of four of 2^-1008.
    Whole sum;
    add_product(sum, exact_square(from_a), exact_minor(from_b, from_c));
    add_product(sum, exact_square(from_b), exact_minor(from_c, from_a));
    add_product(sum, exact_square(from_c), exact_minor(from_a, from_b));
    return static_cast<CircleSide>(sum.sign());
}

}  // namespace tinsmith::core::detail
