// SPDX-License-Identifier: Apache-2.0
#include "core/predicates/orientation.hpp"

#include <cmath>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/quad.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::Quad;

struct Triple {
    Point2 a, b, c;
};

double between(std::mt19937_64& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

double moved(double x, int ulps) {
    for (; ulps > 0; --ulps)
        x = std::nextafter(x, HUGE_VAL);
    for (; ulps < 0; ++ulps)
        x = std::nextafter(x, -HUGE_VAL);
    return x;
}

/// c on the line a-b but for rounding and up to three ulps, `offset` away from the origin.
Triple nearly_collinear(std::mt19937_64& random, double offset, double size) {
    const auto point = [&] {
        const double x = offset + between(random, -size, size);
        return Point2{x, offset / 3.0 + between(random, -size, size)};
    };
    const Point2 a = point(), b = point();
    const double share = between(random, -2.0, 2.0);
    Point2 c{a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
    c.x = moved(c.x, static_cast<int>(random() % 7) - 3);
    c.y = moved(c.y, static_cast<int>(random() % 7) - 3);
    return {a, b, c};
}

int sign_of(Orientation turn) {
    return static_cast<int>(turn);
}

bool filter_decides(const Triple& t) {
    const AreaEstimate area = estimate_doubled_area(t.a, t.b, t.c);
    return std::fabs(area.value) > area.error;
}

/// Tries the orientation and its laws on a triple.
void expect_exact(const Triple& t) {
    const auto [a, b, c] = t;
    const int expected = test::sign(test::area(a, b, c));
    ASSERT_EQ(sign_of(orientation(a, b, c)), expected);
    ASSERT_EQ(sign_of(orientation(b, c, a)), expected);
    ASSERT_EQ(sign_of(orientation(c, a, b)), expected);
    ASSERT_EQ(sign_of(orientation(b, a, c)), -expected);
    ASSERT_EQ(sign_of(orientation(a, c, b)), -expected);
    ASSERT_EQ(sign_of(orientation(c, b, a)), -expected);
    ASSERT_EQ(sign_of(detail::exact_orientation(a, b, c)), expected);
    ASSERT_EQ(is_left(a, b, c), expected > 0);
}

TEST(Orientation, IsExactForPointsMovedOffALineByUlps) {
    struct Family {
        const char* name;
        double offset, size;
    };
    int all_exact = 0;
    for (const Family family :
         {Family{"at the origin", 0.0, 1.0}, Family{"in a projected plane", 5e6, 1e3},
          Family{"detail far away", 5e6, 1e-3}, Family{"at the limit", 9e14, 1e13}}) {
        std::mt19937_64 random(7);
        int exact = 0, collinear = 0;
        constexpr int kCases = 100'000;
        for (int i = 0; i < kCases; ++i) {
            const Triple t = nearly_collinear(random, family.offset, family.size);
            ASSERT_NO_FATAL_FAILURE(expect_exact(t)) << family.name;
            if (!filter_decides(t)) ++exact;
            if (orientation(t.a, t.b, t.c) == Orientation::Collinear) ++collinear;
        }
        std::cout << family.name << ": " << 100.0 * exact / kCases << " % by the exact path, "
                  << 100.0 * collinear / kCases << " % collinear\n";
        all_exact += exact;
    }
    EXPECT_GT(all_exact, 1000);
}

TEST(Orientation, IsCollinearForLatticePointsOfALineAndForNoOthers) {
    std::mt19937_64 random(14);
    for (const double offset : {0.0, 5e6, 9e14}) {
        int collinear = 0;
        for (int i = 0; i < 50'000; ++i) {
            const auto number = [&] { return static_cast<double>(random() % 17) - 8.0; };
            const double dx = number(), dy = number(), times = number();
            const Point2 a{offset + number(), offset + number()}, b{a.x + dx, a.y + dy};
            const double nudge =
                i % 2 == 0 ? 0.0 : std::nextafter(offset + 8.0, HUGE_VAL) - (offset + 8.0);
            const Triple t{a, b, {a.x + times * dx + nudge, a.y + times * dy}};
            ASSERT_NO_FATAL_FAILURE(expect_exact(t));
            if (orientation(t.a, t.b, t.c) == Orientation::Collinear) ++collinear;
        }
        EXPECT_GE(collinear, 25'000);
    }
}

TEST(Orientation, LeavesOrdinaryPointsToTheFilter) {
    std::mt19937_64 random(8);
    int exact = 0;
    constexpr int kCases = 200'000;
    for (int i = 0; i < kCases; ++i) {
        const auto point = [&] {
            const double x = 4e5 + between(random, 0.0, 1e4);
            return Point2{x, 5e6 + between(random, 0.0, 1e4)};
        };
        const Triple t{point(), point(), point()};
        ASSERT_NO_FATAL_FAILURE(expect_exact(t));
        if (!filter_decides(t)) ++exact;
    }
    std::cout << exact << " of " << kCases << " by the exact path\n";
    EXPECT_LT(exact, kCases / 1000);
}

TEST(Orientation, IsExactOnAFineLatticeAroundThreePointsOfALine) {
    // Every double near (0.5, 0.5) against the line through (12, 12) and (24, 24): the textbook
    // case in which the plain determinant gives patches of wrong signs.
    int plain_wrong = 0;
    for (int i = 0; i < 128; ++i) {
        for (int k = 0; k < 128; ++k) {
            const Triple t{{0.5 + i * 0x1p-53, 0.5 + k * 0x1p-53}, {12.0, 12.0}, {24.0, 24.0}};
            ASSERT_NO_FATAL_FAILURE(expect_exact(t));
            const double plain = estimate_doubled_area(t.a, t.b, t.c).value;
            const int sign = plain > 0.0 ? 1 : plain < 0.0 ? -1 : 0;
            if (sign != sign_of(orientation(t.a, t.b, t.c))) ++plain_wrong;
        }
    }
    EXPECT_GT(plain_wrong, 100) << "the case is too easy";
}

TEST(Orientation, IsCollinearForIdenticalPointsAndTheOrigin) {
    // With fused multiply-add the determinant is what rounding left of a product.
    std::mt19937_64 random(9);
    int wrong = 0, fused_wrong = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const Point2 p{between(random, -1e6, 1e6), between(random, -1e6, 1e6)};
        if (orientation(p, p, {0.0, 0.0}) != Orientation::Collinear) ++wrong;
        if (doubled_area(p, p, {0.0, 0.0}) != 0.0) ++wrong;
        if (estimate_doubled_area(p, p, {0.0, 0.0}).value != 0.0) ++wrong;
        if (std::fma(p.x, p.y, -(p.y * p.x)) != 0.0) ++fused_wrong;
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(fused_wrong, 900'000);
}

TEST(Orientation, IsCollinearExactlyWhenTwoPointsAreOne) {
    std::mt19937_64 random(10);
    for (int i = 0; i < 10'000; ++i) {
        const Triple t = nearly_collinear(random, 5e6, 10.0);
        EXPECT_EQ(orientation(t.a, t.a, t.c), Orientation::Collinear);
        EXPECT_EQ(orientation(t.a, t.c, t.c), Orientation::Collinear);
        EXPECT_EQ(orientation(t.c, t.a, t.c), Orientation::Collinear);
    }
}

TEST(Orientation, SeesCoordinatesThatDifferByTheWholeRange) {
    EXPECT_EQ(orientation({0, 0}, {1e15, 0}, {1e15, 1e-60}), Orientation::CounterClockwise);
    EXPECT_EQ(orientation({0, 0}, {1e15, 0}, {-1e15, -1e-60}), Orientation::Clockwise);
    EXPECT_EQ(orientation({1e-60, 1e-60}, {1e15, 1e15}, {-1e15, -1e15}), Orientation::Collinear);
    EXPECT_EQ(orientation({1e-60, 2e-60}, {1e15, 1e15}, {-1e15, -1e15}), Orientation::Clockwise);
}

TEST(DoubledArea, IsRightToATinyPartOfItself) {
    std::mt19937_64 random(11);
    for (const double offset : {0.0, 5e6}) {
        for (int i = 0; i < 100'000; ++i) {
            const Triple t = nearly_collinear(random, offset, 100.0);
            const double expected = static_cast<double>(test::area(t.a, t.b, t.c));
            ASSERT_LE(std::fabs(doubled_area(t.a, t.b, t.c) - expected),
                      0x1p-36 * std::fabs(expected));
        }
    }
}

TEST(DoubledArea, ItsEstimateIsWithinTheErrorItTells) {
    std::mt19937_64 random(12);
    for (int i = 0; i < 100'000; ++i) {
        const Triple t = nearly_collinear(random, 5e6, 100.0);
        const Quad exact = test::area(t.a, t.b, t.c);
        const AreaEstimate estimate = estimate_doubled_area(t.a, t.b, t.c);
        ASSERT_LE(std::fabs(static_cast<double>(Quad(estimate.value) - exact)), estimate.error);
    }
}

TEST(DoubledArea, CompensatedIsWithin2ToTheMinus102OfTheProducts) {
    std::mt19937_64 random(13);
    for (int i = 0; i < 100'000; ++i) {
        const Triple t = nearly_collinear(random, 5e6, 100.0);
        const Quad exact = test::area(t.a, t.b, t.c);
        const double error =
            std::fabs(static_cast<double>(Quad(compensated_doubled_area(t.a, t.b, t.c)) - exact));
        const double products = std::fabs((t.a.x - t.c.x) * (t.b.y - t.c.y)) +
                                std::fabs((t.a.y - t.c.y) * (t.b.x - t.c.x));
        ASSERT_LE(error, 0x1p-102 * products + 0x1p-52 * std::fabs(static_cast<double>(exact)));
    }
}

TEST(IsAhead, ComparesAlongTheLineInEveryDirection) {
    for (const Point2 d :
         {Point2{1, 0}, Point2{-1, 0}, Point2{0, 1}, Point2{0, -1}, Point2{2, 3}, Point2{-3, 1}}) {
        const Point2 a{10, 20}, b{10 + d.x, 20 + d.y};
        EXPECT_TRUE(is_ahead(a, b, b));
        EXPECT_TRUE(is_ahead(a, b, {10 + 5 * d.x, 20 + 5 * d.y}));
        EXPECT_FALSE(is_ahead(a, b, a));
        EXPECT_FALSE(is_ahead(a, b, {10 - d.x, 20 - d.y}));
    }
}

}  // namespace
}  // namespace tinsmith
