// SPDX-License-Identifier: Apache-2.0
#include "core/predicates/orientation.hpp"

#include "core/predicates/expansion.hpp"

namespace tinsmith::core {

double compensated_doubled_area(Point2 a, Point2 b, Point2 c) {
    const Exact acx = exact_difference(a.x, c.x);
    const Exact bcy = exact_difference(b.y, c.y);
    const Exact acy = exact_difference(a.y, c.y);
    const Exact bcx = exact_difference(b.x, c.x);
    const Exact left = exact_product(acx.value, bcy.value);
    const Exact right = exact_product(acy.value, bcx.value);
    const double mixed = (acx.value * bcy.rest + acx.rest * bcy.value) -
                         (acy.value * bcx.rest + acy.rest * bcx.value);
    return (left.value - right.value) + ((left.rest - right.rest) + mixed);
}

namespace detail {

namespace {

/// (p + p') (q + q') - (r + r') (s + s'), where the primes are what rounding the differences left.
Expansion<16> exact_determinant(Point2 a, Point2 b, Point2 c) {
    const Exact acx = exact_difference(a.x, c.x);
    const Exact bcy = exact_difference(b.y, c.y);
    const Exact acy = exact_difference(a.y, c.y);
    const Exact bcx = exact_difference(b.x, c.x);
    Expansion<16> sum;
    const auto add = [&sum](double u, double v) {
        if (u != 0.0 && v != 0.0) sum.add(exact_product(u, v));
    };
    // Small terms first: the expansion stays short. On gridded data the rests are all zero.
    add(acx.rest, bcy.rest);
    add(-acy.rest, bcx.rest);
    add(acx.rest, bcy.value);
    add(acx.value, bcy.rest);
    add(-acy.rest, bcx.value);
    add(-acy.value, bcx.rest);
    add(acx.value, bcy.value);
    add(-acy.value, bcx.value);
    return sum;
}

}  // namespace

Orientation exact_orientation(Point2 a, Point2 b, Point2 c) {
    return static_cast<Orientation>(exact_determinant(a, b, c).sign());
}

double accurate_doubled_area(Point2 a, Point2 b, Point2 c) {
    return exact_determinant(a, b, c).estimate();
}

}  // namespace detail

}  // namespace tinsmith::core
