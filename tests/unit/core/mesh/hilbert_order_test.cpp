// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/hilbert_order.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/point_clouds.hpp"

namespace tinsmith::core {
namespace {

TEST(HilbertOrder, GoesFromNeighbourToNeighbourOnAGrid) {
    // 64 columns and rows stretched so that each is a cell of the curve's own.
    constexpr int kSide = 64;
    std::vector<Point3> points;
    for (int i = 0; i < kSide * kSide; ++i)
        points.push_back({double(i / kSide), double(i % kSide), 0.0});
    points.push_back({double(kSide), double(kSide), 0.0});  // the corner of the box
    const auto order = hilbert_order(points);
    ASSERT_EQ(order.size(), points.size());
    std::size_t neighbours = 0;
    for (std::size_t i = 1; i < order.size(); ++i) {
        const Point3 &p = points[order[i - 1]], &q = points[order[i]];
        if (std::fabs(p.x - q.x) + std::fabs(p.y - q.y) == 1.0) ++neighbours;
    }
    // All steps but those to the corner and away from it.
    EXPECT_GE(neighbours, points.size() - 3);
}

TEST(HilbertOrder, HasEveryPointOnceAndEqualOnesByIndexSideBySide) {
    for (const test::PointCloud& cloud : test::point_clouds()) {
        SCOPED_TRACE(cloud.name);
        std::vector<Point3> points = cloud.make(9'000, 3);
        const std::vector<Point3> again(points.begin(), points.begin() + 500);
        points.insert(points.end(), again.begin(), again.end());
        const auto order = hilbert_order(points);
        std::vector<std::uint32_t> sorted = order;
        std::sort(sorted.begin(), sorted.end());
        ASSERT_EQ(sorted.size(), points.size());
        for (std::uint32_t i = 0; i < sorted.size(); ++i)
            ASSERT_EQ(sorted[i], i);
        // As many runs of equal positions as there are positions: none is parted.
        std::size_t runs = 1;
        for (std::size_t i = 1; i < order.size(); ++i) {
            if (points[order[i]].plan() != points[order[i - 1]].plan())
                ++runs;
            else
                ASSERT_LT(order[i - 1], order[i]);
        }
        std::vector<std::pair<double, double>> positions;
        for (const Point3& p : points)
            positions.emplace_back(p.x, p.y);
        std::sort(positions.begin(), positions.end());
        positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
        EXPECT_EQ(runs, positions.size());
    }
}

TEST(HilbertOrder, IsShortAlsoWhereAllButOnePointShareACell) {
    // Thousands of points within a millimetre, and one a thousand kilometres away.
    std::vector<Point3> points = test::point_cloud("scattered").make(10'000, 5);
    for (Point3& p : points)
        p = {p.x * 1e-7, p.y * 1e-7, 0.0};
    points.push_back({1e6, 1e6, 0.0});
    const auto order = hilbert_order(points);
    double length = 0.0;
    for (std::size_t i = 1; i < order.size(); ++i) {
        const Point3 &p = points[order[i - 1]], &q = points[order[i]];
        if (p.x < 1e5 && q.x < 1e5) length += std::hypot(p.x - q.x, p.y - q.y);
    }
    // About 0.9 times the root of area times number; in random order 52 times as much as the side
    // for each hundred points.
    EXPECT_LT(length, 1.5 * 1e-3 * std::sqrt(10'000.0));
}

TEST(HilbertOrder, OfNothingAndOfOnePosition) {
    EXPECT_TRUE(hilbert_order({}).empty());
    const std::vector<Point3> same(100, Point3{1, 2, 3});
    const auto order = hilbert_order(same);
    for (std::uint32_t i = 0; i < order.size(); ++i)
        EXPECT_EQ(order[i], i);
}

}  // namespace
}  // namespace tinsmith::core
