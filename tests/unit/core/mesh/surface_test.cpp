// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/mesh/walk.hpp"
#include "tests/support/quad.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

TEST(Elevation, InATriangleIsThatOfItsCornersAtItsCorners) {
    const Tin tin = test::built(test::grid(4, 4, test::Diagonals::Alternate));
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t)
        for (const VertexId v : tin.triangle({t}).vertices)
            EXPECT_EQ(elevation_in(tin, {t}, tin.plan(v)), tin.vertex(v).z);
}

TEST(Elevation, InATriangleIsExactOnSimpleSlopes) {
    const MeshData data{{{0, 0, 1}, {8, 0, 17}, {0, 8, 33}}, {{0, 1, 2}}, {}};
    const Tin tin = test::built(data);  // z = 1 + 2 x + 4 y
    for (int x = 0; x <= 8; ++x)
        for (int y = 0; x + y <= 8; ++y)
            EXPECT_EQ(elevation_in(tin, {0}, {x * 1.0, y * 1.0}), 1.0 + 2 * x + 4 * y);
}

TEST(Elevation, InALevelTriangleIsItsElevationToTheLastBit) {
    const MeshData data{{{0.1, 0.3, 0.7}, {8.3, 0.9, 0.7}, {0.7, 8.1, 0.7}}, {{0, 1, 2}}, {}};
    const Tin tin = test::built(data);
    for (int i = 1; i < 20; ++i)
        EXPECT_EQ(elevation_in(tin, {0}, {0.1 + 0.2 * i, 0.5 + 0.1 * i}), 0.7);
}

TEST(Elevation, NeverLeavesTheRangeOfTheCorners) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> number(0.0, 1.0);
    const MeshData data{{{0, 0, 100.1}, {1, 1e-9, 100.3}, {0.5, 2e-9, 100.2}}, {{0, 1, 2}}, {}};
    const Tin tin = test::built(data);
    for (int i = 0; i < 10'000; ++i) {
        const double z = elevation_in(tin, {0}, {number(random), 2e-9 * number(random)});
        ASSERT_GE(z, 100.1);
        ASSERT_LE(z, 100.3);
        const double on = elevation_on(tin, {{0}, 0}, {number(random), 1e-9 * number(random)});
        ASSERT_GE(on, 100.1);
        ASSERT_LE(on, 100.3);
    }
}

TEST(Elevation, IsRightToAFewUlpsInNarrowTriangles) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> share(0.1, 0.9);
    for (const double width : {1.0, 1e-3, 1e-6, 1e-9, 1e-12}) {
        for (int i = 0; i < 1000; ++i) {
            const MeshData data{
                {{0, 0, 1}, {3, 2, 5}, {1.5 - 2 * width, 1 + 3 * width, 7}}, {{0, 1, 2}}, {}};
            const Tin tin = test::built(data);
            const double along = share(random), up = share(random) * std::min(along, 1 - along);
            const Point2 p{3 * along - 4 * width * up, 2 * along + 6 * width * up};
            const auto& v = data.vertices;
            const test::Quad a = test::area(v[1].plan(), v[2].plan(), p);
            const test::Quad b = test::area(v[2].plan(), v[0].plan(), p);
            const test::Quad c = test::area(v[0].plan(), v[1].plan(), p);
            const test::Quad z =
                (a * test::Quad(v[0].z) + b * test::Quad(v[1].z) + c * test::Quad(v[2].z)) /
                (a + b + c);
            ASSERT_NEAR(elevation_in(tin, {0}, p), static_cast<double>(z), 8e-15) << width;
        }
    }
}

TEST(Elevation, OnAnEdgeIsTheSameFromEitherSide) {
    const Tin tin = test::built(test::grid(5, 5, test::Diagonals::Alternate, 0.1));
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            const Side twin = tin.twin(side);
            if (!twin.valid()) continue;
            const Point2 a = tin.plan(tin.origin(side)), b = tin.plan(tin.destination(side));
            for (int k = 0; k < 50; ++k) {
                const double s = k == 0 ? 0.5 : share(random);
                const Point2 p{a.x + (b.x - a.x) * s, a.y + (b.y - a.y) * s};
                ASSERT_EQ(elevation_on(tin, side, p), elevation_on(tin, twin, p));
            }
        }
    }
}

TEST(Elevation, OnAnEdgeIsExactAtItsEndsAndMiddle) {
    const Tin tin = test::built({{{0, 0, 1}, {4, 2, 9}, {0, 5, 3}}, {{0, 1, 2}}, {}});
    EXPECT_EQ(elevation_on(tin, {{0}, 0}, {0, 0}), 1.0);
    EXPECT_EQ(elevation_on(tin, {{0}, 0}, {4, 2}), 9.0);
    EXPECT_EQ(elevation_on(tin, {{0}, 0}, {2, 1}), 5.0);
    EXPECT_EQ(elevation_on(tin, {{0}, 2}, {0, 2.5}), 2.0);
}

TEST(SteepestSlope, IsRiseOverRun) {
    EXPECT_EQ(steepest_slope({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0.0);
    EXPECT_DOUBLE_EQ(steepest_slope({0, 0, 0}, {1, 0, 3}, {0, 1, 4}), 5.0);
    EXPECT_DOUBLE_EQ(steepest_slope({0, 0, 7}, {10, 0, 7}, {3, 2, 9}), 1.0);
}

TEST(SmallestAngle, IsThatOfKnownTriangles) {
    EXPECT_NEAR(angle_degrees(smallest_angle_measure({0, 0, 0}, {1, 0, 0}, {0, 1, 0})), 45.0,
                1e-12);
    EXPECT_NEAR(angle_degrees(smallest_angle_measure({0, 0, 0}, {2, 0, 0}, {1, std::sqrt(3.0), 0})),
                60.0, 1e-6);
    // Upright in space, so that its plan is a needle: the angle is that of the triangle in 3D.
    EXPECT_NEAR(angle_degrees(smallest_angle_measure({0, 0, 0}, {1e-9, 0, 3}, {0, 1e-9, -3})),
                std::atan2(1e-9, 3.0) / 3.14159265358979 * 180.0, 1e-6);
    EXPECT_NEAR(angle_degrees(smallest_angle_measure({1, 0, 0}, {0, 1, 0}, {0, 0, 1})), 60.0, 1e-6);
    EXPECT_EQ(smallest_angle_measure({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), 0.0);
    EXPECT_EQ(smallest_angle_measure({1, 1, 1}, {1, 1, 1}, {1, 1, 1}), 0.0);
}

TEST(Aspect, IsThatOfKnownTriangles) {
    EXPECT_NEAR(aspect_measure({0, 0, 0}, {2, 0, 0}, {1, std::sqrt(3.0), 0}), 0.75, 1e-15);
    EXPECT_DOUBLE_EQ(aspect_measure({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0.25);
    // Longest edge 5, shortest height 12 / 5; the same turned about, out of the level.
    EXPECT_DOUBLE_EQ(aspect_measure({0, 0, 0}, {3, 0, 0}, {0, 4, 0}), 0.48 * 0.48);
    EXPECT_DOUBLE_EQ(aspect_measure({0, 0, 0}, {0, 0, 3}, {0, 4, 0}), 0.48 * 0.48);
    EXPECT_EQ(aspect_measure({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), 0.0);
    EXPECT_EQ(aspect_measure({1, 1, 1}, {1, 1, 1}, {1, 1, 1}), 0.0);
}

TEST(SmallestAngle, IsTheSameWhateverTheOrder) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> number(-10.0, 10.0);
    for (int i = 0; i < 10'000; ++i) {
        std::array<Point3, 3> p;
        for (Point3& q : p) {
            q.x = number(random);
            q.y = i % 3 == 0 ? 1.0 : number(random);
            q.z = number(random);
        }
        const double measure = smallest_angle_measure(p[0], p[1], p[2]);
        ASSERT_EQ(smallest_angle_measure(p[0], p[2], p[1]), measure);
        ASSERT_EQ(smallest_angle_measure(p[1], p[0], p[2]), measure);
        ASSERT_EQ(smallest_angle_measure(p[1], p[2], p[0]), measure);
        ASSERT_EQ(smallest_angle_measure(p[2], p[0], p[1]), measure);
        ASSERT_EQ(smallest_angle_measure(p[2], p[1], p[0]), measure);
        const double aspect = aspect_measure(p[0], p[1], p[2]);
        ASSERT_EQ(aspect_measure(p[1], p[2], p[0]), aspect);
        ASSERT_EQ(aspect_measure(p[2], p[1], p[0]), aspect);
    }
}

TEST(SmallestAngle, AgreesWithTheArcsOfItsCorners) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> number(-10.0, 10.0);
    for (int i = 0; i < 10'000; ++i) {
        std::array<Point3, 3> p;
        for (Point3& q : p) {
            q.x = number(random);
            q.y = number(random);
            q.z = number(random);
        }
        double least = 180.0;
        for (unsigned k = 0; k < 3; ++k) {
            const Point3 &a = p[k], &b = p[(k + 1) % 3], &c = p[(k + 2) % 3];
            const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
            const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
            const double cosine =
                (ux * vx + uy * vy + uz * vz) / (std::hypot(ux, uy, uz) * std::hypot(vx, vy, vz));
            least = std::min(least, std::acos(std::clamp(cosine, -1.0, 1.0)) * 57.29577951308232);
        }
        ASSERT_NEAR(angle_degrees(smallest_angle_measure(p[0], p[1], p[2])), least, 1e-5);
    }
}

}  // namespace
}  // namespace tinsmith::core
