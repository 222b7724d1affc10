// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/report.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::built;
using test::grid;
using test::integrate_checked;
using test::line;

TEST(Report, CountsALineOnAGridAsByHand) {
    // Cells of 1 with rising diagonals. From (0.5, 0.25) to (2.5, 0.25): the uprights at 1 and 2,
    // the diagonals at 1.25 and 2.25; both ends inside triangles.
    Tin tin = built(grid(4, 4));
    const auto outcome = integrate_checked(tin, {line({{0.5, 0.25}, {2.5, 0.25}})});
    ASSERT_EQ(outcome.broken, "");
    const ShapeReport& report = outcome.shape();
    EXPECT_EQ(report.segments, 1u);
    EXPECT_EQ(report.crossings, 4u);
    EXPECT_EQ(report.vertices_added, 6u);
    EXPECT_EQ(report.triangles_added, 12u);  // two for each vertex inside
    EXPECT_TRUE(report.outside.empty());
    EXPECT_EQ(report.max_plan_deviation, 0.0);
    const auto data = tin.to_data();
    EXPECT_EQ(data.constraints.size(), 5u);
    for (const double x : {0.5, 1.0, 1.25, 2.0, 2.25, 2.5})
        EXPECT_TRUE(std::any_of(data.vertices.begin() + 25, data.vertices.end(),
                                [x](const Point3& v) {
                                    return v.plan() == Point2{x, 0.25};
                                }))
            << x;
}

TEST(Report, CountsALineAcrossTheOutlineAsByHand) {
    // From outside to outside: each vertex on the outline brings one triangle, each other two.
    Tin tin = built(grid(4, 4));
    const auto outcome = integrate_checked(tin, {line({{-1, 0.25}, {5, 0.25}})});
    ASSERT_EQ(outcome.broken, "");
    const ShapeReport& report = outcome.shape();
    EXPECT_EQ(report.crossings, 9u);
    EXPECT_EQ(report.vertices_added, 9u);
    EXPECT_EQ(report.triangles_added, 2u * 1 + 7u * 2);
    EXPECT_EQ(report.outside.size(), 2u);
}

TEST(Report, CountsEachShapeForItself) {
    Tin tin = built(grid(4, 4));
    const auto outcome = integrate_checked(
        tin, {line({{0.5, 0.25}, {2.5, 0.25}}), line({{1.5, 0.1}, {1.5, 0.4}}), line({{3, 3}})});
    ASSERT_EQ(outcome.broken, "");
    EXPECT_EQ(outcome.shape(0).vertices_added, 6u);
    // Its two ends, and where it meets the line of before: a constraint that was there.
    EXPECT_EQ(outcome.shape(1).vertices_added, 3u);
    EXPECT_EQ(outcome.shape(1).triangles_added, 6u);
    EXPECT_EQ(outcome.shape(1).segments, 1u);
    EXPECT_EQ(outcome.shape(2).vertices_added, 0u);
    EXPECT_EQ(outcome.shape(2).segments, 0u);
}

TEST(Report, DoesNotCountCrossingsWithTheShapeItself) {
    Tin tin = built(test::one_triangle());
    const auto outcome =
        integrate_checked(tin, {test::ring({{10, 10}, {40, 40}, {40, 10}, {10, 40}})});
    ASSERT_EQ(outcome.broken, "");
    EXPECT_EQ(outcome.shape().crossings, 0u);
    EXPECT_EQ(outcome.shape().vertices_added, 5u);
}

TEST(Report, SaysWhichPathLeftTheMesh) {
    Tin tin = built(grid(4, 4));
    Shape shape = line({{1, 1}, {2, 1}});
    shape.paths.push_back({{{1, 2}, {-1, 2}}, false});
    shape.paths.push_back({{{9, 9}}, false});
    const auto outcome = integrate_checked(tin, {shape});
    ASSERT_EQ(outcome.broken, "");
    ASSERT_EQ(outcome.shape().outside.size(), 2u);
    EXPECT_EQ(outcome.shape().outside[0].path, 1u);
    EXPECT_EQ(outcome.shape().outside[0].points, (std::vector<Point2>{{0, 2}, {-1, 2}}));
    EXPECT_EQ(outcome.shape().outside[1].path, 2u);
    EXPECT_EQ(outcome.shape().outside[1].points, (std::vector<Point2>{{9, 9}}));
}

TEST(Report, TimesAddUpToTheWholeByTheCallersClock) {
    double now = 1000.0;
    std::vector<double> readings;
    IntegrateOptions options;
    options.clock_ms = [&] {
        now += 0.5 + static_cast<double>(readings.size() % 7);
        readings.push_back(now);
        return now;
    };
    Tin tin = built(grid(6, 6));
    Shape shape = test::ring({});
    for (int i = 0; i < 200; ++i)
        shape.paths[0].points.push_back(
            {3 + 2.2 * std::cos(i * 0.0314159), 3 + 2.2 * std::sin(i * 0.0314159)});
    const auto outcome = integrate_checked(tin, {shape, line({{0, 0.3}, {6, 5.2}})}, options);
    ASSERT_EQ(outcome.broken, "");
    const StageTimes& times = outcome.report.time_ms;
    EXPECT_NEAR(times.locate + times.integrate + times.improve, readings.back() - readings.front(),
                1e-9);
    EXPECT_GT(times.locate, 0.0);
    EXPECT_GT(times.integrate, 0.0);
    EXPECT_GT(times.improve, 0.0);
}

TEST(Report, TimesAreZeroWithoutAClock) {
    Tin tin = built(grid(4, 4));
    const auto report = integrate(tin, std::vector{line({{0.5, 0.25}, {2.5, 0.25}})}, {});
    ASSERT_TRUE(report);
    EXPECT_EQ(report->time_ms.locate + report->time_ms.integrate + report->time_ms.improve, 0.0);
}

TEST(Report, TheClockDecidesNothing) {
    Tin with = built(grid(6, 6)), without = built(grid(6, 6));
    const std::vector<Shape> shapes{test::ring({{0.6, 0.7}, {5.1, 0.9}, {5.3, 5.4}, {0.2, 4.8}})};
    double now = 0.0;
    IntegrateOptions options;
    options.clock_ms = [&now] { return now += 1e9; };
    ASSERT_TRUE(integrate(with, shapes, options));
    ASSERT_TRUE(integrate(without, shapes, {}));
    EXPECT_TRUE(test::same_slots(with, without));
}

TEST(Report, AnglesAreThoseOfTheTrianglesTouched) {
    // A level triangle of 45, 45 and 90 degrees, and a point in its middle.
    Tin tin = built({{{0, 0, 0}, {6, 0, 0}, {0, 6, 0}}, {{0, 1, 2}}, {}});
    const auto outcome = integrate_checked(tin, {line({{2, 2}})});
    ASSERT_EQ(outcome.broken, "");
    const AngleSummary& angles = outcome.shape().smallest_angle_deg;
    EXPECT_NEAR(angles.before, 45.0, 1e-9);
    EXPECT_NEAR(angles.p1_before, 45.0, 1e-9);
    // The least of (0,0) (6,0) (2,2) is at (6,0): atan(2 / 4); of (6,0) (0,6) (2,2), at both
    // ends: 45 degrees less that.
    EXPECT_NEAR(angles.after, 45.0 - std::atan2(2.0, 4.0) * 57.29577951308232, 1e-9);
}

TEST(Report, AnglesOfAnEditThatTouchesNothingAreZero) {
    Tin tin = built(grid(4, 4));
    const auto outcome = integrate_checked(tin, {line({{1, 1}, {3, 1}})});
    ASSERT_EQ(outcome.broken, "");
    EXPECT_EQ(outcome.shape().smallest_angle_deg.before, 0.0);
    EXPECT_EQ(outcome.shape().smallest_angle_deg.after, 0.0);
    EXPECT_EQ(outcome.shape().max_vertical_deviation, 0.0);
}

TEST(Report, StrictImprovesTheAnglesThatNoneLeaves) {
    Shape shape = test::ring({});
    for (int i = 0; i < 40; ++i)
        shape.paths[0].points.push_back(
            {30 + 20 * std::cos(i * 0.157079632), 30 + 20 * std::sin(i * 0.157079632)});
    IntegrateOptions plain;
    plain.improve = Improve::None;
    Tin one = built(test::one_triangle()), two = built(test::one_triangle());
    const auto none = integrate_checked(one, {shape}, plain);
    const auto strict = integrate_checked(two, {shape});
    ASSERT_EQ(none.broken + strict.broken, "");
    EXPECT_GT(strict.shape().smallest_angle_deg.after, none.shape().smallest_angle_deg.after);
    EXPECT_LE(strict.shape().smallest_angle_deg.after, strict.shape().smallest_angle_deg.p1_after);
    EXPECT_GT(strict.shape().edges_swapped, none.shape().edges_swapped);
}

}  // namespace
}  // namespace tinsmith
