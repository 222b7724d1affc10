// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/swap_criterion.hpp"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/quad.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

using test::Quad;

SwapQuad swapped(const SwapQuad& q) {
    return {q.d, q.c, q.a, q.b};
}

/// Convex in plan, the diagonals cross somewhere inside; elevations anywhere in `height`.
SwapQuad random_quad(std::mt19937_64& random, double height) {
    std::uniform_real_distribution<double> number(0.1, 5.0), up(-height, height);
    SwapQuad q;
    q.a = {-number(random), 0.0, up(random)};
    q.b = {number(random), 0.0, up(random)};
    const double lean = number(random) - 2.5;
    const double above = number(random), below = number(random);
    q.c = {lean * above / 10, above, up(random)};
    q.d = {-lean * below / 10, -below, up(random)};
    return q;
}

/// Angle between the normals on both sides of a-b, degrees, by its own arithmetic.
long double bend(const SwapQuad& q) {
    using Vector = std::array<long double, 3>;
    const auto normal = [](Point3 a, Point3 b, Point3 c) {
        const Vector u{static_cast<long double>(b.x) - a.x, static_cast<long double>(b.y) - a.y,
                       static_cast<long double>(b.z) - a.z};
        const Vector v{static_cast<long double>(c.x) - a.x, static_cast<long double>(c.y) - a.y,
                       static_cast<long double>(c.z) - a.z};
        return Vector{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                      u[0] * v[1] - u[1] * v[0]};
    };
    const Vector m = normal(q.a, q.b, q.c), n = normal(q.b, q.a, q.d);
    const long double sine =
        std::hypot(m[1] * n[2] - m[2] * n[1], m[2] * n[0] - m[0] * n[2], m[0] * n[1] - m[1] * n[0]);
    return std::atan2(sine, m[0] * n[0] + m[1] * n[1] + m[2] * n[2]) * 57.29577951308232L;
}

TEST(SwapCriterion, OnlyAStrictlyConvexQuadCanBeSwapped) {
    const SwapQuad square{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}};
    EXPECT_TRUE(can_swap(square));
    SwapQuad straight = square;  // a, d and c on one line
    straight.a = {0.5, 0.5, 0};
    EXPECT_FALSE(can_swap(straight));
    SwapQuad dart = square;
    dart.a = {0.6, 0.6, 0};
    EXPECT_FALSE(can_swap(dart));
    SwapQuad barely = square;  // by one ulp, which elevations say nothing about
    barely.a = {0.5, std::nextafter(0.5, 0.0), 1e6};
    EXPECT_TRUE(can_swap(barely));
}

TEST(SwapCriterion, TheShortDiagonalHasTheBetterAspect) {
    const SwapQuad q{{-2, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    EXPECT_TRUE(improves_aspect(q));
    EXPECT_FALSE(improves_aspect(swapped(q)));
    // Elevations make the short way the long one.
    const SwapQuad steep{{-2, 0, 0}, {2, 0, 0}, {0, 1, 9}, {0, -1, -9}};
    EXPECT_FALSE(improves_aspect(steep));
    EXPECT_TRUE(improves_aspect(swapped(steep)));
}

TEST(SwapCriterion, OfTwoDiagonalsThatAreAsGoodNeitherImproves) {
    const SwapQuad square{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}};
    EXPECT_FALSE(improves_aspect(square));
    EXPECT_FALSE(improves_aspect(swapped(square)));
    std::mt19937_64 random(1);
    for (int i = 0; i < 20'000; ++i) {
        const SwapQuad q = random_quad(random, i % 2 == 0 ? 0.0 : 3.0);
        ASSERT_FALSE(improves_aspect(q) && improves_aspect(swapped(q)));
    }
}

TEST(SwapCriterion, TheBendIsThatOfTheNormals) {
    std::mt19937_64 random(2);
    int more = 0, less = 0;
    for (int i = 0; i < 20'000; ++i) {
        const SwapQuad q = random_quad(random, i % 2 == 0 ? 0.1 : 10.0);
        const long double now = bend(q), then = bend(swapped(q));
        if (std::fabs(then - now) < 1e-9L) continue;
        ++(then < now ? less : more);
        ASSERT_EQ(bends_no_more(q), then < now) << i;
    }
    EXPECT_GT(more, 5000);
    EXPECT_GT(less, 5000);
}

TEST(SwapCriterion, FlatIsFlatBeforeAndAfter) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 1000; ++i) {
        SwapQuad q = random_quad(random, 0.0);
        for (Point3* p : {&q.a, &q.b, &q.c, &q.d})
            p->z = 812.7 + 0.3 * p->x - 0.7 * p->y;  // a plane, to within rounding
        ASSERT_TRUE(bends_no_more(q) && bends_no_more(swapped(q))) << i;
    }
}

TEST(SwapCriterion, TheGapOfASaddleIsTheHeightOfOneDiagonalAboveTheOther) {
    const SwapQuad saddle{{-2, 0, 0}, {2, 0, 0}, {0, 1, 3}, {0, -1, 3}};
    EXPECT_GE(vertical_gap(saddle), 3.0);
    EXPECT_LE(vertical_gap(saddle), 3.0 * (1 + 0x1p-32));
    // The diagonals cross at the origin: at height 1 on the way from 0 to 4, at 2 on that from 3
    // to 0.
    const SwapQuad uneven{{-1, 0, 0}, {3, 0, 4}, {0, 2, 0}, {0, -1, 3}};
    EXPECT_NEAR(vertical_gap(uneven), 1.0, 4 * 0x1p-32);
    const SwapQuad level{{-1, 0, 7}, {3, 0, 7}, {0, 2, 7}, {0, -1, 7}};
    EXPECT_EQ(vertical_gap(level), 0.0);
}

TEST(SwapCriterion, TheGapIsNeverLessThanTheDistanceOfTheDiagonals) {
    std::mt19937_64 random(4);
    const auto check = [](const SwapQuad& q, int i) {
        const Quad above = test::area(q.a.plan(), q.b.plan(), q.c.plan());
        const Quad below = test::area(q.b.plan(), q.a.plan(), q.d.plan());
        const Quad at_a = test::area(q.a.plan(), q.d.plan(), q.c.plan());
        const Quad at_b = test::area(q.d.plan(), q.b.plan(), q.c.plan());
        const Quad gap = (Quad(q.a.z) * at_b + Quad(q.b.z) * at_a) / (at_a + at_b) -
                         (Quad(q.c.z) * below + Quad(q.d.z) * above) / (above + below);
        const Quad distance = gap < 0 ? -gap : gap;
        const auto [low, high] = std::minmax({q.a.z, q.b.z, q.c.z, q.d.z});
        ASSERT_TRUE(Quad(vertical_gap(q)) >= distance) << i;
        ASSERT_TRUE(Quad(vertical_gap(q)) <= distance + Quad(0x1p-32) * Quad(high - low)) << i;
    };
    for (int i = 0; i < 20'000; ++i) {
        SwapQuad q = random_quad(random, 10.0);
        if (i % 2 == 1) {  // far away, and a needle in a direction that is nowhere near an axis
            for (Point3* p : {&q.a, &q.b, &q.c, &q.d})
                *p = {5e6 + 3 * p->x - 2e-6 * p->y, 5e6 + 2 * p->x + 3e-6 * p->y, p->z + 5e3};
            if (!can_swap(q)) continue;
        }
        check(q, i);
    }
}

}  // namespace
}  // namespace tinsmith::core
