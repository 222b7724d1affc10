// SPDX-License-Identifier: Apache-2.0
// A snap distance: what the mesh has near enough to a path takes the path's place.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/mesh/check.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::built;
using test::grid;
using test::line;
using test::ring;

ShapeReport snapped(Tin& tin, const Shape& shape, double snap) {
    IntegrateOptions options;
    options.snap = snap;
    verify::Verifier verifier(tin.to_data());
    const auto report = integrate(tin, {&shape, 1}, options);
    EXPECT_TRUE(report.ok()) << (report.ok() ? "" : report.errors()[0].detail);
    if (!report.ok()) return {};
    EXPECT_TRUE(check_tin(tin).empty());
    const test::Operation operation{{&shape, 1}, options, *report, tin};
    EXPECT_EQ(test::check_guarantees(verifier, operation), std::vector<std::string>{});
    EXPECT_LE(report->shapes[0].max_plan_deviation, snap);
    return report->shapes[0];
}

TEST(Snap, APassingSegmentGoesThroughAVertexNearby) {
    Tin tin = built(grid(4, 4));
    const ShapeReport report = snapped(tin, line({{0, 1.0005}, {4, 1.0005}}), 0.001);
    EXPECT_EQ(report.vertices_added, 0u);  // along the row of posts, ends included
    EXPECT_EQ(report.crossings, 0u);
    EXPECT_NEAR(report.max_plan_deviation, 0.0005, 1e-12);
    EXPECT_EQ(report.chains.at(0).vertices.size(), 5u);
}

TEST(Snap, OfZeroTakesNothingButWhatRoundingForces) {
    Tin tin = built(grid(4, 4));
    const ShapeReport report = snapped(tin, line({{0.5, 1.0005}, {3.5, 1.0005}}), 0.0);
    EXPECT_GT(report.crossings, 5u);
    EXPECT_LT(report.max_plan_deviation, 1e-14);
}

TEST(Snap, AnEndNearAnEdgeGoesOntoItAndTheSurfaceStays) {
    Tin tin = built(grid(4, 4));
    const ShapeReport report = snapped(tin, line({{1.5, 1.002}, {1.5, 1.2}}), 0.01);
    EXPECT_EQ(report.vertices_added, 2u);
    EXPECT_EQ(tin.plan(report.chains.at(0).vertices.front()), (Point2{1.5, 1.0}));
}

TEST(Snap, IsMeasuredToTheInputSegmentHoweverOftenItSnaps) {
    // Posts that drift away from the line: each near it, or not taken.
    MeshData mesh = grid(10, 2);
    for (auto& v : mesh.vertices)
        if (v.y == 1.0) v.y += 0.004 * v.x;
    Tin tin = built(mesh);
    const ShapeReport report = snapped(tin, line({{0.5, 1}, {9.5, 1}}), 0.01);
    EXPECT_LE(report.max_plan_deviation, 0.01);
    EXPECT_GT(report.max_plan_deviation, 0.007);  // the posts at 1 and 2
    EXPECT_GT(report.crossings, 7u);              // the others' edges are crossed
}

TEST(Snap, NoiseBelowItBecomesOneVertex) {
    Tin tin = built(grid(4, 4));
    std::vector<Point2> noise;
    for (int i = 0; i < 20; ++i)
        noise.push_back({1.3 + 0.0001 * (i % 3), 1.6 + 0.0001 * (i % 5)});
    const ShapeReport report = snapped(tin, ring(noise), 0.001);
    EXPECT_EQ(report.vertices_added, 1u);
}

TEST(Snap, RandomLinesOnRandomMeshesStayWithinIt) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    int refused = 0;
    for (int i = 0; i < 400; ++i) {
        MeshData mesh = grid(8, 8);
        for (auto& v : mesh.vertices) {
            v.x += 0.3 * (unit(random) - 0.5);
            v.y += 0.3 * (unit(random) - 0.5);
        }
        Tin tin = built(mesh);
        std::vector<Point2> points;
        for (int k = 0; k < 12; ++k) {
            const double x = 0.5 + 7 * unit(random);
            points.push_back({x, 0.5 + 7 * unit(random)});
        }
        IntegrateOptions options;
        options.snap = std::pow(10.0, -4.0 * unit(random)) * 0.3;
        const Shape shape = ring(points);
        verify::Verifier verifier(tin.to_data());
        const auto report = integrate(tin, {&shape, 1}, options);
        if (!report.ok()) {
            ++refused;
            ADD_FAILURE() << i << " snap " << options.snap << ": " << report.errors()[0].detail;
            continue;
        }
        EXPECT_TRUE(check_tin(tin).empty()) << i;
        EXPECT_LE(report->shapes[0].max_plan_deviation, options.snap) << i;
        const test::Operation operation{{&shape, 1}, options, *report, tin};
        EXPECT_EQ(test::check_guarantees(verifier, operation), std::vector<std::string>{}) << i;
        // Every input segment's ends are joined by the chain.
        EXPECT_EQ(report->shapes[0].chains.size(), 1u) << i;
        const auto& chain = report->shapes[0].chains[0].vertices;
        EXPECT_EQ(chain.front(), chain.back()) << i;
    }
    EXPECT_EQ(refused, 0);
}

}  // namespace
}  // namespace tinsmith
