// SPDX-License-Identifier: Apache-2.0
// Paths that bring elevations of their own.
#include <cmath>

#include <gtest/gtest.h>

#include "core/mesh/check.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::built;
using test::grid;

Shape breakline(std::vector<Point2> points, std::vector<double> elevations, bool closed = false) {
    return {{{std::move(points), closed, std::move(elevations)}}};
}

double elevation_at(const Tin& tin, Point2 p) {
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
        if (tin.plan({v}) == p) return tin.vertex({v}).z;
    return NAN;
}

Report integrated(Tin& tin, const Shape& shape, const IntegrateOptions& options = {},
                  Undo* undo = nullptr) {
    const auto report = integrate(tin, {&shape, 1}, options, undo);
    EXPECT_TRUE(report.ok()) << (report.ok() ? "" : report.errors()[0].detail);
    EXPECT_TRUE(check_tin(tin).empty());
    return report.ok() ? *report : Report{{ShapeReport{}}, {}};
}

TEST(OwnElevation, IsLinearAlongTheSegmentAtEveryVertexOfTheChain) {
    Tin tin = built(grid(4, 4));
    const Report report = integrated(tin, breakline({{0.25, 1.25}, {3.75, 1.25}}, {10, 17}));
    const auto& chain = report.shapes[0].chains.at(0).vertices;
    EXPECT_EQ(chain.size(), report.shapes[0].vertices_added);
    for (const VertexId v : chain)
        EXPECT_NEAR(tin.vertex(v).z, 10 + 2 * (tin.plan(v).x - 0.25), 1e-12);
    EXPECT_EQ(elevation_at(tin, {0.25, 1.25}), 10.0);
    EXPECT_EQ(elevation_at(tin, {3.75, 1.25}), 17.0);
}

TEST(OwnElevation, MovesNothingOutsideTheTrianglesThatTouchTheChain) {
    Tin tin = built(grid(6, 6));
    const Tin before = tin;
    const Report report =
        integrated(tin, breakline({{1.25, 1.5}, {2.5, 2.25}, {1.5, 2.5}}, {5, 6, 7}, true));
    for (std::uint32_t v = 0; v < before.vertex_count(); ++v)
        EXPECT_EQ(tin.vertex({v}).z, before.vertex({v}).z) << v;
    // Each vertex that is not on the chain lies on the old surface; here the old vertices only.
    EXPECT_GT(report.shapes[0].max_elevation_change, 3.0);
    EXPECT_LT(report.shapes[0].max_vertical_deviation, 1e-12);
}

TEST(OwnElevation, ReportsTheLargestChange) {
    Tin tin = built(test::one_triangle());  // z = x / 4 + y / 2
    const Report report = integrated(tin, breakline({{20, 20}, {40, 20}}, {15 + 3, 20 - 4.5}));
    EXPECT_NEAR(report.shapes[0].max_elevation_change, 4.5, 1e-12);
}

TEST(OwnElevation, OfAPointAloneAndOfAnOldVertex) {
    Tin tin = built(grid(2, 2));
    integrated(tin, breakline({{0.25, 0.5}}, {42}));
    EXPECT_EQ(elevation_at(tin, {0.25, 0.5}), 42.0);
    integrated(tin, breakline({{1, 1}}, {-7}));
    EXPECT_EQ(elevation_at(tin, {1, 1}), -7.0);
    EXPECT_EQ(tin.bounds().max.z, 42.0);
    EXPECT_EQ(tin.bounds().min.z, -7.0);
}

TEST(OwnElevation, LoweringTheHighestVertexLowersTheBounds) {
    Tin tin = built(test::one_triangle());
    Undo undo;
    integrated(tin, breakline({{0, 100}}, {1}), {}, &undo);
    EXPECT_EQ(tin.bounds().max.z, 25.0);
    take_back(tin, undo);
    EXPECT_EQ(tin.bounds().max.z, 50.0);
}

TEST(OwnElevation, WhereTwoBreaklinesCrossTheNewOneWinsUnlessTheOldIsAskedFor) {
    for (const bool old : {false, true}) {
        Tin tin = built(test::one_triangle());
        integrated(tin, breakline({{10, 30}, {50, 30}}, {100, 140}));
        IntegrateOptions options;
        options.on_crossing = old ? OnCrossing::Old : OnCrossing::New;
        integrated(tin, breakline({{30, 10}, {30, 50}}, {200, 240}), options);
        EXPECT_DOUBLE_EQ(elevation_at(tin, {30, 30}), old ? 120.0 : 220.0);
        EXPECT_EQ(elevation_at(tin, {30, 50}), 240.0);
    }
}

TEST(OwnElevation, AnOldConstraintKeepsItsVerticesWhereItIsAskedTo) {
    Tin tin = built(test::one_triangle());
    integrated(tin, breakline({{10, 30}, {50, 30}}, {100, 140}));
    IntegrateOptions options;
    options.on_crossing = OnCrossing::Old;
    integrated(tin, breakline({{10, 30}, {10, 60}}, {7, 8}), options);
    EXPECT_EQ(elevation_at(tin, {10, 30}), 100.0);
    EXPECT_EQ(elevation_at(tin, {10, 60}), 8.0);
}

TEST(OwnElevation, ThenStrictMovesNothing) {
    // The triangles around a lifted point are no longer one plane: none of their edges may swap.
    Tin tin = built(test::one_triangle());
    integrated(tin, breakline({{30, 30}}, {60}));
    const test::Outcome outcome =
        test::integrate_checked(tin, {test::ring({{20, 20}, {45, 25}, {25, 45}})}, {}, true);
    EXPECT_EQ(outcome.broken, "");
}

TEST(OwnElevation, AnglesBeforeAreThoseOfTheGroundAsItWas) {
    // One level triangle whose corner is lifted: half of a square, 45 degrees, before.
    Tin tin = built({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}});
    const Report report = integrated(tin, breakline({{0, 0}}, {100}));
    EXPECT_NEAR(report.shapes[0].smallest_angle_deg.before, 45.0, 1e-9);
    EXPECT_LT(report.shapes[0].smallest_angle_deg.after, 1.0);
}

TEST(OwnElevation, IsTakenBackBitForBit) {
    Tin tin = built(grid(5, 5));
    const Tin before = tin;
    Undo undo;
    integrated(tin, breakline({{0.5, 0.25}, {4.25, 4}, {1, 4}, {2, 2}}, {9, -9, 3, 0}, true), {},
               &undo);
    EXPECT_FALSE(test::same_bytes(tin.to_data(), before.to_data()));
    take_back(tin, undo);
    EXPECT_TRUE(test::same_slots(tin, before));
    EXPECT_EQ(tin.bounds().max, before.bounds().max);
    EXPECT_EQ(tin.next_facet(), before.next_facet());
}

TEST(OwnElevation, OnePositionHasOneElevation) {
    Tin tin = built(grid(2, 2));
    const Shape shape = breakline({{0.5, 0.5}, {1, 1.5}, {1, 1.5}}, {1, 2, 3});
    const auto report = integrate(tin, {&shape, 1}, {});
    ASSERT_FALSE(report.ok());
    EXPECT_EQ(report.errors()[0].code, ErrorCode::ElevationTwice);
    EXPECT_EQ(report.errors()[0].place.point, 2u);
}

TEST(OwnElevation, EveryPointMustHaveOneThatIsANumber) {
    Tin tin = built(grid(2, 2));
    const Shape shape = breakline({{0.5, 0.5}, {1, 1.5}, {1.5, 1.5}}, {1, NAN});
    const auto report = integrate(tin, {&shape, 1}, {});
    ASSERT_FALSE(report.ok());
    ASSERT_EQ(report.errors().size(), 2u);
    EXPECT_EQ(report.errors()[0].code, ErrorCode::CoordinateNotFinite);
    EXPECT_EQ(report.errors()[1].code, ErrorCode::ElevationMissing);
}

}  // namespace
}  // namespace tinsmith
