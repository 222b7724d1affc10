// SPDX-License-Identifier: Apache-2.0
#include "core/predicates/in_circle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/predicates/orientation.hpp"
#include "tests/verify/exact.hpp"

namespace tinsmith {
namespace {

using namespace core;
using Four = std::array<Point2, 4>;

double between(std::mt19937_64& random, double low, double high) {
    return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

double moved(double x, int ulps) {
    for (; ulps > 0; --ulps)
        x = std::nextafter(x, HUGE_VAL);
    for (; ulps < 0; ++ulps)
        x = std::nextafter(x, -HUGE_VAL);
    return x;
}

int sign_of(CircleSide side) {
    return static_cast<int>(side);
}

/// By the filter of the header alone: 0 where it does not decide.
bool filter_decides(const Four& p) {
    const auto [a, b, c, d] = p;
    const double ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x,
                 cy = c.y - d.y;
    const double as = ax * ax + ay * ay, bs = bx * bx + by * by, cs = cx * cx + cy * cy;
    const double determinant =
        as * (bx * cy - cx * by) + bs * (cx * ay - ax * cy) + cs * (ax * by - bx * ay);
    return std::fabs(determinant) >
           detail::kInCircleError * (as * (bs + cs) + bs * cs) + detail::kInCircleUnderflow;
}

/// Tries the predicate and its laws on four points, in any order.
void expect_exact(const Four& p) {
    const auto [a, b, c, d] = p;
    const int expected = verify::circle_side_of(a, b, c, d);
    ASSERT_EQ(sign_of(in_circle(a, b, c, d)), expected);
    ASSERT_EQ(sign_of(detail::exact_in_circle(a, b, c, d)), expected);
    std::array<int, 4> places{0, 1, 2, 3};
    do {
        int inversions = 0;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = i + 1; k < 4; ++k)
                inversions += places[i] > places[k] ? 1 : 0;
        const auto at = [&](std::size_t i) { return p[static_cast<std::size_t>(places[i])]; };
        ASSERT_EQ(sign_of(in_circle(at(0), at(1), at(2), at(3))),
                  inversions % 2 == 0 ? expected : -expected);
    } while (std::ranges::next_permutation(places).found);
}

TEST(InCircle, IsAsOneWouldDrawIt) {
    EXPECT_EQ(in_circle({0, 0}, {1, 0}, {0, 1}, {0.5, 0.5}), CircleSide::Inside);
    EXPECT_EQ(in_circle({0, 0}, {1, 0}, {0, 1}, {1, 1}), CircleSide::On);
    EXPECT_EQ(in_circle({0, 0}, {1, 0}, {0, 1}, {1, 1.0000001}), CircleSide::Outside);
    EXPECT_EQ(in_circle({0, 0}, {0, 1}, {1, 0}, {0.5, 0.5}), CircleSide::Outside)
        << "clockwise: the other way round";
    EXPECT_EQ(in_circle({0, 0}, {1, 0}, {0, 1}, {0, 0}), CircleSide::On);
}

TEST(InCircle, IsExactForPointsMovedOffACircleByUlps) {
    struct Family {
        const char* name;
        double offset, radius;
    };
    for (const Family family :
         {Family{"at the origin", 0.0, 1.0}, Family{"in a projected plane", 5e6, 1e3},
          Family{"detail far away", 5e6, 1e-3}, Family{"at the limit", 9e14, 1e13}}) {
        std::mt19937_64 random(7);
        int exact = 0;
        constexpr int kCases = 2'000;
        for (int i = 0; i < kCases; ++i) {
            Four p;
            for (Point2& q : p) {
                const double turn = between(random, 0.0, 2 * std::numbers::pi);
                q = {family.offset + family.radius * std::cos(turn),
                     family.offset / 3 + family.radius * std::sin(turn)};
                q.x = moved(q.x, static_cast<int>(random() % 5) - 2);
                q.y = moved(q.y, static_cast<int>(random() % 5) - 2);
            }
            ASSERT_NO_FATAL_FAILURE(expect_exact(p)) << family.name;
            if (!filter_decides(p)) ++exact;
        }
        std::cout << family.name << ": " << 100.0 * exact / kCases << " % by the exact path\n";
    }
}

TEST(InCircle, IsOnForLatticePointsOfACircleAndForNoOthers) {
    // x^2 + y^2 = 5^2 13^2 17^2 has 108 solutions.
    std::vector<Point2> ring;
    for (int x = -1105; x <= 1105; ++x)
        for (int y = -1105; y <= 1105; ++y)
            if (x * x + y * y == 1105 * 1105) ring.push_back({double(x), double(y)});
    ASSERT_EQ(ring.size(), 108U);
    std::mt19937_64 random(3);
    for (const double scale : {1.0, 0x1p-20, 0x1p20, 1.0 / 3.0}) {
        for (const double offset : {0.0, 5e6, 5e11}) {
            int on = 0;
            for (std::size_t i = 0; i < 500; ++i) {
                Four p;
                for (Point2& q : p) {
                    const Point2 at = ring[random() % ring.size()];
                    q = {offset + scale * at.x, offset + scale * at.y};
                }
                if (i % 5 == 0 && p[i % 4].x != 0.0) p[i % 4].x = moved(p[i % 4].x, 1);
                ASSERT_NO_FATAL_FAILURE(expect_exact(p)) << scale << " " << offset;
                if (in_circle(p[0], p[1], p[2], p[3]) == CircleSide::On) ++on;
            }
            if (scale != 1.0 / 3.0 && (offset == 0.0 || scale >= 1.0)) {
                EXPECT_GE(on, 350);
            }
        }
    }
}

TEST(InCircle, IsOnForEveryUprightRectangle) {
    std::mt19937_64 random(4);
    for (int i = 0; i < 1'000; ++i) {
        const double x = between(random, -1e6, 1e6), y = between(random, -1e6, 1e6);
        const double u = between(random, -1e6, 1e6), v = between(random, -1e6, 1e6);
        Four p{Point2{x, y}, Point2{u, y}, Point2{u, v}, Point2{x, v}};
        ASSERT_NO_FATAL_FAILURE(expect_exact(p));
        ASSERT_EQ(in_circle(p[0], p[1], p[2], p[3]), CircleSide::On);
        p[2].x = moved(p[2].x, i % 2 == 0 ? 1 : -1);
        ASSERT_NO_FATAL_FAILURE(expect_exact(p));
        ASSERT_NE(in_circle(p[0], p[1], p[2], p[3]), CircleSide::On);
    }
}

TEST(InCircle, IsExactForPointsUlpsApart) {
    std::mt19937_64 random(5);
    for (int i = 0; i < 2'000; ++i) {
        Four p;
        for (Point2& q : p)
            q = {moved(4e5, static_cast<int>(random() % 4)),
                 moved(5e6, static_cast<int>(random() % 4))};
        ASSERT_NO_FATAL_FAILURE(expect_exact(p));
    }
}

TEST(InCircle, IsExactOnAFineLatticeAroundTheCircle) {
    int plain_wrong = 0;
    for (int i = 0; i < 48; ++i) {
        for (int k = 0; k < 48; ++k) {
            const Point2 a{12, 12}, b{24, 12}, c{24, 24};
            const Point2 d{moved(12, i - 24), moved(24, k - 24)};
            ASSERT_NO_FATAL_FAILURE(expect_exact({a, b, c, d}));
            // Written out with nothing subtracted, as a textbook's 4 x 4 determinant begins.
            const auto lifted = [](Point2 p) { return p.x * p.x + p.y * p.y; };
            const double plain =
                lifted(d) - (lifted(a) + lifted(c)) + (d.x * -36.0 + d.y * -36.0) + 36.0 * 36.0;
            if ((plain > 0) != (in_circle(a, b, c, d) == CircleSide::Outside)) ++plain_wrong;
        }
    }
    EXPECT_GT(plain_wrong, 100) << "the case is too easy";
}

TEST(InCircle, SeesCoordinatesThatDifferByTheWholeRange) {
    const double low = 1e-60, high = 1e15;
    const double values[] = {0.0, low, moved(low, 1), -low, 1.0, high, moved(high, -1), -high};
    std::mt19937_64 random(6);
    for (int i = 0; i < 4'000; ++i) {
        Four p;
        for (Point2& q : p)
            q = {values[random() % std::size(values)], values[random() % std::size(values)]};
        ASSERT_NO_FATAL_FAILURE(expect_exact(p));
    }
    EXPECT_EQ(in_circle({0, 0}, {low, 0}, {0, low}, {low, low}), CircleSide::On);
    EXPECT_EQ(in_circle({0, 0}, {low, 0}, {0, low}, {low, moved(low, 1)}), CircleSide::Outside);
}

TEST(InCircle, LeavesOrdinaryPointsToTheFilter) {
    std::mt19937_64 random(8);
    int exact = 0;
    constexpr int kCases = 20'000;
    for (int i = 0; i < kCases; ++i) {
        Four p;
        for (Point2& q : p)
            q = {4e5 + between(random, 0, 1e4), 5e6 + between(random, 0, 1e4)};
        ASSERT_EQ(sign_of(in_circle(p[0], p[1], p[2], p[3])),
                  verify::circle_side_of(p[0], p[1], p[2], p[3]));
        if (!filter_decides(p)) ++exact;
    }
    EXPECT_LT(exact, kCases / 1000);
}

}  // namespace
}  // namespace tinsmith
