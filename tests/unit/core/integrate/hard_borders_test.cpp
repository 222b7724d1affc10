// SPDX-License-Identifier: Apache-2.0
// Borders, hubs and lines that are met again and again.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/border_shapes.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::built;
using test::grid;
using test::integrate_checked;
using test::line;
using test::Outcome;
using test::ring;

TEST(HardCase, BordersAndHubsMetVeryOften) {
    for (const test::BorderShape& shape : test::border_shapes()) {
        for (const std::size_t size : {5u, 36u, 150u}) {
            const test::BorderCase made = shape.make(size);
            Tin tin = built(made.mesh);
            ASSERT_TRUE(made.before.empty() || integrate(tin, made.before, {}).ok());
            const Outcome outcome = integrate_checked(tin, made.shapes, {}, made.before.empty());
            EXPECT_EQ(outcome.broken, "") << shape.name << " of " << size;
        }
    }
}

TEST(HardCase, TheSamePolygonTwiceOverBordersAndHubs) {
    for (const test::BorderShape& shape : test::border_shapes()) {
        const test::BorderCase made = shape.make(64);
        Tin tin = built(made.mesh);
        ASSERT_TRUE(made.before.empty() || integrate(tin, made.before, {}).ok());
        ASSERT_TRUE(integrate(tin, made.shapes, {}).ok()) << shape.name;
        const Outcome again = integrate_checked(tin, made.shapes, {}, false);
        ASSERT_EQ(again.broken, "") << shape.name;
        for (const ShapeReport& report : again.report.shapes) {
            EXPECT_EQ(report.vertices_added, 0u) << shape.name;
            EXPECT_EQ(report.triangles_added, 0u) << shape.name;
        }
    }
}

TEST(HardCase, ASpikeThatRunsBackOnItselfInAnyDirection) {
    std::mt19937_64 random(21);
    std::uniform_real_distribution<double> number(-0.5, 4.5);  // also out of the mesh and back
    for (const Point2 corner : {Point2{0, 0}, Point2{5e6, 4.5e6}}) {
        for (int k = 0; k < 100; ++k) {
            const Point2 from{corner.x + number(random), corner.y + number(random)};
            const Point2 tip{corner.x + number(random), corner.y + number(random)};
            Tin once = built(grid(4, 4, test::Diagonals::Alternate, 1.0, corner));
            Tin back = once;
            const Outcome there = integrate_checked(once, {line({from, tip})});
            const Outcome spike = integrate_checked(back, {line({from, tip, from})});
            if (there.broken.starts_with("OUTSIDE_MESH")) continue;
            ASSERT_EQ(there.broken, "") << k;
            ASSERT_EQ(spike.broken, "") << k;
            EXPECT_EQ(spike.shape().vertices_added, there.shape().vertices_added) << k;
        }
    }
}

TEST(HardCase, TouchingASlantedBoundaryFromInside) {
    // Whatever rounding makes of the point on the outline, the ring stays and touches.
    std::mt19937_64 random(22);
    std::uniform_real_distribution<double> share(0.05, 0.95);
    for (const Point2 corner : {Point2{0, 0}, Point2{5e6, 4.5e6}}) {
        const double cosine = std::cos(0.7), sine = std::sin(0.7);
        const auto turned = [&](double x, double y) {
            return Point2{corner.x + x * cosine - y * sine, corner.y + x * sine + y * cosine};
        };
        MeshData data = grid(4, 4, test::Diagonals::Alternate);
        for (Point3& v : data.vertices) {
            const Point2 p = turned(v.x, v.y);
            v = {p.x, p.y, v.z};
        }
        for (int k = 0; k < 100; ++k) {
            const Point2 touch = turned(4.0 * share(random), 0.0);
            Tin tin = built(data);
            const Outcome outcome =
                integrate_checked(tin, {ring({turned(0.8, 1.3), touch, turned(3.1, 1.4)})});
            ASSERT_EQ(outcome.broken, "") << k;
            EXPECT_LE(outcome.shape().outside.size(), 2u) << k;
            // One vertex there, on the outline or within rounding of it.
            EXPECT_EQ(outcome.shape().vertices_added, 3 + outcome.shape().crossings) << k;
        }
    }
}

TEST(HardCase, OneSegmentOfAMillionthOfAMetre) {
    for (const double size : {1.0, 100.0, 1e5}) {
        for (const double turn : {0.0, 0.3, 1.1, 2.5}) {
            const Point2 from{size * 0.3, size * 0.31};
            const Point2 to{from.x + 1e-6 * std::cos(turn), from.y + 1e-6 * std::sin(turn)};
            Tin tin = built(test::one_triangle(size));
            const Outcome outcome = integrate_checked(tin, {line({from, to})});
            ASSERT_EQ(outcome.broken, "") << size;
            EXPECT_EQ(outcome.shape().vertices_added, 2u);
        }
    }
}

}  // namespace
}  // namespace tinsmith
