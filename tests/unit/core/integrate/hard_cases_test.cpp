// SPDX-License-Identifier: Apache-2.0
// One path that meets a mesh in an awkward way, a test for each way, every guarantee held against
// every result.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

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

/// Integrates into a grid of 4 x 4 unit cells with rising diagonals, strict and without improving;
/// the counts must be the same.
Outcome on_grid(const Shape& shape) {
    IntegrateOptions plain;
    plain.improve = Improve::None;
    Tin unimproved = built(grid(4, 4));
    const Outcome first = integrate_checked(unimproved, {shape}, plain);
    EXPECT_EQ(first.broken, "") << "without improving";
    Tin tin = built(grid(4, 4));
    Outcome outcome = integrate_checked(tin, {shape});
    EXPECT_EQ(outcome.broken, "");
    EXPECT_EQ(test::vertex_set(tin), test::vertex_set(unimproved));
    if (outcome.broken.empty() && first.broken.empty()) {
        EXPECT_EQ(outcome.shape().crossings, first.shape().crossings);
        return outcome;
    }
    outcome.report.shapes.resize(1);
    return outcome;
}

TEST(HardCase, StartAndEndOnAVertex) {
    const Outcome outcome = on_grid(line({{1, 1}, {3, 2}}));
    EXPECT_EQ(outcome.shape().vertices_added, outcome.shape().crossings);
    EXPECT_EQ(outcome.shape().crossings, 1u);  // at (2, 1.5); both diagonals end at its ends
}

TEST(HardCase, StartAndEndOnAnEdge) {
    // From the middle of an upright edge to the middle of the next: one diagonal between.
    const Outcome outcome = on_grid(line({{1, 1.25}, {2, 1.25}}));
    EXPECT_EQ(outcome.shape().crossings, 1u);
    EXPECT_EQ(outcome.shape().vertices_added, 3u);
}

TEST(HardCase, StartAndEndOutside) {
    const Outcome outcome = on_grid(line({{-1, 1.25}, {5, 1.25}}));
    EXPECT_EQ(outcome.shape().crossings, 9u);  // 5 upright edges and 4 diagonals
    EXPECT_EQ(outcome.shape().vertices_added, 9u);
    ASSERT_EQ(outcome.shape().outside.size(), 2u);
    EXPECT_EQ(outcome.shape().outside[0].points, (std::vector<Point2>{{-1, 1.25}, {0, 1.25}}));
    EXPECT_EQ(outcome.shape().outside[1].points, (std::vector<Point2>{{4, 1.25}, {5, 1.25}}));
}

TEST(HardCase, AlongAnExistingEdgeWholly) {
    for (const Shape& shape :
         {line({{1, 1}, {2, 1}}), line({{1, 1}, {2, 2}}), line({{0, 0}, {4, 4}}),
          line({{4, 3}, {0, 3}}), line({{0, 0}, {4, 0}, {4, 4}})}) {
        const Outcome outcome = on_grid(shape);
        EXPECT_EQ(outcome.shape().vertices_added, 0u);
        EXPECT_EQ(outcome.shape().triangles_added, 0u);
        EXPECT_EQ(outcome.shape().crossings, 0u);
    }
}

TEST(HardCase, AlongAnExistingEdgeInPart) {
    EXPECT_EQ(on_grid(line({{1.25, 1}, {1.75, 1}})).shape().vertices_added, 2u);
    EXPECT_EQ(on_grid(line({{0.5, 0.5}, {3.25, 3.25}})).shape().vertices_added, 2u);
    EXPECT_EQ(on_grid(line({{1, 2.5}, {1, 0.5}})).shape().vertices_added, 2u);
    // Along the boundary, each half of one triangle only.
    const Outcome rim = on_grid(line({{0.5, 0}, {1.5, 0}}));
    EXPECT_EQ(rim.shape().vertices_added, 2u);
    EXPECT_EQ(rim.shape().triangles_added, 2u);
}

TEST(HardCase, ThroughAVertex) {
    const Outcome outcome = on_grid(line({{0.5, 1.5}, {3.5, 2.5}}));  // through (2, 2)
    EXPECT_EQ(outcome.shape().vertices_added, outcome.shape().crossings + 2);
    EXPECT_EQ(on_grid(line({{0, 4}, {4, 0}})).shape().crossings, 4u);  // diagonals, once each
}

TEST(HardCase, SegmentsOfNoLengthAndPointsGivenTwice) {
    const Outcome once = on_grid(line({{0.5, 0.25}, {2.5, 1.75}}));
    const Outcome twice =
        on_grid(line({{0.5, 0.25}, {0.5, 0.25}, {0.5, 0.25}, {2.5, 1.75}, {2.5, 1.75}}));
    EXPECT_EQ(twice.shape().vertices_added, once.shape().vertices_added);
    EXPECT_EQ(twice.shape().segments, 1u);
    EXPECT_EQ(on_grid(line({{1.5, 1.25}, {1.5, 1.25}})).shape().vertices_added, 1u);
    EXPECT_EQ(on_grid(ring({{1.5, 1.25}})).shape().vertices_added, 1u);
    EXPECT_EQ(on_grid(ring({{1.5, 1.25}, {2.5, 1.25}})).shape().segments, 2u);
}

TEST(HardCase, APointAlone) {
    EXPECT_EQ(on_grid(line({{1.5, 1.25}})).shape().triangles_added, 2u);
    EXPECT_EQ(on_grid(line({{1.5, 1.5}})).shape().triangles_added, 2u);
    EXPECT_EQ(on_grid(line({{1.5, 0}})).shape().triangles_added, 1u);
    EXPECT_EQ(on_grid(line({{2, 2}})).shape().triangles_added, 0u);
}

TEST(HardCase, TheSamePolygonTwice) {
    for (const Improve improve : {Improve::None, Improve::Strict}) {
        for (const double turn : {0.0, 0.1, 1.0, 2.5}) {
            Shape star = ring({});
            for (int i = 0; i < 10; ++i) {
                const double r = i % 2 == 0 ? 1.9 : 0.7, angle = turn + 0.628318530717958 * i;
                star.paths[0].points.push_back(
                    {2.1 + r * std::cos(angle), 2.0 + r * std::sin(angle)});
            }
            IntegrateOptions options;
            options.improve = improve;
            Tin tin = built(grid(4, 4));
            ASSERT_EQ(integrate_checked(tin, {star}, options).broken, "");
            const MeshData after = tin.to_data();
            const Outcome again = integrate_checked(tin, {star}, options, false);
            ASSERT_EQ(again.broken, "");
            EXPECT_EQ(again.shape().vertices_added, 0u);
            EXPECT_EQ(again.shape().triangles_added, 0u);
            EXPECT_EQ(again.shape().edges_swapped, 0u);
            EXPECT_EQ(again.shape().crossings, 0u);
            EXPECT_TRUE(test::same_bytes(tin.to_data(), after));
        }
    }
}

TEST(HardCase, ASpikeThatRunsBackOnItself) {
    const Outcome there = on_grid(line({{0.5, 0.25}, {2.7, 1.9}, {3.3, 0.4}}));
    const Outcome back =
        on_grid(line({{0.5, 0.25}, {2.7, 1.9}, {3.3, 0.4}, {2.7, 1.9}, {0.5, 0.25}}));
    EXPECT_EQ(back.shape().vertices_added, there.shape().vertices_added);
    EXPECT_EQ(back.shape().crossings, there.shape().crossings);
    EXPECT_EQ(back.shape().segments, 4u);
    on_grid(ring({{0.5, 0.25}, {2.7, 1.9}, {1.6, 1.075}}));  // its last point on its first side
}

TEST(HardCase, ABowTie) {
    const Outcome outcome = on_grid(ring({{0.6, 0.7}, {3.1, 3.3}, {3.2, 0.8}, {0.7, 3.1}}));
    EXPECT_EQ(outcome.shape().segments, 4u);
    // Four corners, the crossings with the mesh, and the one with itself.
    EXPECT_EQ(outcome.shape().vertices_added, 4 + outcome.shape().crossings + 1);
}

TEST(HardCase, ABowTieThatCrossesItselfOnAVertexAndOnAnEdge) {
    EXPECT_EQ(on_grid(ring({{1.5, 1.5}, {2.5, 2.5}, {2.5, 1.5}, {1.5, 2.5}})).broken, "");
    EXPECT_EQ(on_grid(ring({{0.5, 1.25}, {1.5, 1.75}, {1.5, 1.25}, {0.5, 1.75}})).broken, "");
}

TEST(HardCase, AroundTheWholeMesh) {
    Tin tin = built(grid(4, 4));
    const MeshData before = tin.to_data();
    const Outcome outcome = integrate_checked(tin, {ring({{-1, -1}, {5, -1}, {5, 5}, {-1, 5}})});
    ASSERT_EQ(outcome.broken, "");
    EXPECT_EQ(outcome.shape().vertices_added, 0u);
    EXPECT_TRUE(test::same_bytes(tin.to_data(), before));
}

TEST(HardCase, AroundTheWholeMeshOnItsOutline) {
    Tin tin = built(grid(4, 4));
    const Outcome outcome = integrate_checked(tin, {ring({{0, 0}, {4, 0}, {4, 4}, {0, 4}})});
    ASSERT_EQ(outcome.broken, "");
    EXPECT_EQ(outcome.shape().vertices_added, 0u);
    EXPECT_EQ(tin.to_data().constraints.size(), 16u);
    EXPECT_TRUE(outcome.shape().outside.empty());
}

TEST(HardCase, InsideASingleTriangle) {
    Tin tin = built(test::one_triangle());
    const Outcome outcome =
        integrate_checked(tin, {ring({{10, 10}, {40, 12}, {35, 30}, {20, 22}, {12, 50}})});
    ASSERT_EQ(outcome.broken, "");
    EXPECT_EQ(outcome.shape().vertices_added, 5u);
    EXPECT_EQ(outcome.shape().triangles_added, 10u);
    EXPECT_EQ(outcome.shape().crossings, 0u);
}

TEST(HardCase, AHundredThousandNoisySegmentsInsideASingleTriangle) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> noise(0.999, 1.001);
    Shape shape = ring({});
    constexpr int kCount = 100'000;
    for (int i = 0; i < kCount; ++i) {
        const double angle = 6.283185307179586 * i / kCount, r = 20.0 * noise(random);
        shape.paths[0].points.push_back({30 + r * std::cos(angle), 30 + r * std::sin(angle)});
    }
    Tin tin = built(test::one_triangle());
    const Outcome outcome = integrate_checked(tin, {shape});
    ASSERT_EQ(outcome.broken, "");
    EXPECT_EQ(outcome.shape().vertices_added, static_cast<std::uint64_t>(kCount));
    EXPECT_EQ(outcome.shape().segments, static_cast<std::uint64_t>(kCount));
    EXPECT_EQ(outcome.shape().crossings, 0u);
}

TEST(HardCase, ARingOfAHundredThousandSegments) {
    constexpr int kCount = 100'000;
    Shape shape = ring({});
    for (int i = 0; i < kCount; ++i) {
        const double angle = 6.283185307179586 * i / kCount;
        const double r = 8.0 + 1.5 * std::sin(40 * angle);
        shape.paths[0].points.push_back({10 + r * std::cos(angle), 10 + r * std::sin(angle)});
    }
    Tin tin = built(grid(20, 20));
    const Outcome outcome = integrate_checked(tin, {shape});
    ASSERT_EQ(outcome.broken, "");
    EXPECT_EQ(outcome.shape().segments, static_cast<std::uint64_t>(kCount));
    EXPECT_GT(outcome.shape().crossings, 200u);
    EXPECT_EQ(outcome.shape().chains.size(), 1u);
}

TEST(HardCase, AMillionthOfAMetreInsideASingleTriangle) {
    for (const Point2 at : {Point2{30, 30}, Point2{0.5, 0.5}, Point2{1e-5, 1e-5}}) {
        Shape shape = ring({});
        for (int i = 0; i < 12; ++i)
            shape.paths[0].points.push_back({at.x + 5e-7 * std::cos(i * 0.52359877559829882),
                                             at.y + 5e-7 * std::sin(i * 0.52359877559829882)});
        Tin tin = built(test::one_triangle());
        const Outcome outcome = integrate_checked(tin, {shape});
        ASSERT_EQ(outcome.broken, "");
        EXPECT_EQ(outcome.shape().vertices_added, 12u);
    }
}

TEST(HardCase, TouchingTheBoundaryFromInside) {
    const Outcome point = on_grid(ring({{1.3, 1.2}, {0, 1.75}, {1.3, 2.4}}));
    EXPECT_TRUE(point.shape().outside.empty());
    const Outcome vertex = on_grid(ring({{1.3, 1.2}, {0, 2}, {1.3, 2.4}}));
    EXPECT_TRUE(vertex.shape().outside.empty());
    const Outcome side = on_grid(ring({{0.5, 0.75}, {2.3, 0}, {3.1, 0}, {3.3, 1.2}}));
    EXPECT_TRUE(side.shape().outside.empty());
    const Outcome corner = on_grid(ring({{0, 0}, {1.4, 0.3}, {0.3, 1.4}}));
    EXPECT_TRUE(corner.shape().outside.empty());
}

TEST(HardCase, TouchingTheBoundaryFromOutside) {
    const Outcome vertex = on_grid(line({{-1, 1}, {0, 2}, {-1, 3}}));
    EXPECT_EQ(vertex.shape().vertices_added, 0u);
    EXPECT_EQ(vertex.shape().outside.size(), 2u);
    const Outcome edge = on_grid(line({{-1, 1}, {0, 2.5}, {-1, 3}}));
    EXPECT_EQ(edge.shape().vertices_added, 1u);
    EXPECT_EQ(edge.shape().outside.size(), 2u);
    const Outcome passing = on_grid(line({{-1, 1}, {1, -1}}));  // through the corner (0, 0)
    EXPECT_EQ(passing.shape().vertices_added, 0u);
    EXPECT_EQ(passing.shape().outside.size(), 2u);
}

TEST(HardCase, LeavingAndComingBack) {
    const Outcome outcome = on_grid(line({{1.3, 1.2}, {-1, 1.6}, {1.2, 2.3}, {2, 5}, {3.3, 3.2}}));
    ASSERT_EQ(outcome.shape().outside.size(), 2u);
    EXPECT_EQ(outcome.shape().outside[0].points.size(), 3u);
    EXPECT_EQ(outcome.shape().outside[0].points[1], (Point2{-1, 1.6}));
    EXPECT_EQ(outcome.shape().outside[1].points[1], (Point2{2, 5}));
}

TEST(HardCase, ReversedAndRotatedRingsGiveTheSamePlanVerticesAndSurface) {
    std::vector<Point2> points{{0.3, 0.7}, {1.9, 0.2}, {3.4, 1.1},
                               {2.2, 1.6}, {3.7, 3.3}, {1.1, 2.9}};
    Tin first = built(grid(4, 4));
    const Outcome expected = integrate_checked(first, {ring(points)});
    ASSERT_EQ(expected.broken, "");
    for (int turn = 0; turn < 12; ++turn) {
        std::rotate(points.begin(), points.begin() + 1, points.end());
        if (turn == 6) std::reverse(points.begin(), points.end());
        Tin tin = built(grid(4, 4));
        const Outcome outcome = integrate_checked(tin, {ring(points)});
        ASSERT_EQ(outcome.broken, "");
        // The same positions to the bit; elevations are interpolated in other triangles.
        const auto found = test::vertex_set(tin), wanted = test::vertex_set(first);
        ASSERT_EQ(found.size(), wanted.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_EQ(found[i].first, wanted[i].first) << "turn " << turn;
            EXPECT_NEAR(found[i].second, wanted[i].second, 1e-15) << "turn " << turn;
        }
        EXPECT_EQ(outcome.shape().crossings, expected.shape().crossings);
    }
}

}  // namespace
}  // namespace tinsmith
