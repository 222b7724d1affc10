// SPDX-License-Identifier: Apache-2.0
#include "api/formats/quantization.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

Box<double> box(double low, double high) {
    return {{low, low, low}, {high, high, high}};
}

TEST(PositionGrid, IsAsCoarseAsTheToleranceAllows) {
    const auto grid = grid_for(box(0, 1000), 0.005);
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->step(), 0x1p-7);
    EXPECT_EQ(grid->period(), 128);
    EXPECT_EQ(grid->origin, (std::array<double, 3>{500, 500, 500}));
    EXPECT_EQ(grid_for(box(0, 1), 0.6)->step(), 1.0);
    EXPECT_EQ(grid_for(box(0, 1), 100)->step(), 128.0);
    EXPECT_EQ(grid_for(box(0, 1), 100)->period(), 1);
}

TEST(PositionGrid, LeavesRoomWhereHalfAStepWouldBeTheTolerance) {
    EXPECT_EQ(grid_for(box(0, 1000), 0x1p-8)->step(), 0x1p-8);
}

TEST(PositionGrid, RefusesWhatItCannotHoldAndNamesWhatItCan) {
    EXPECT_FALSE(grid_for(box(0, 1000), 1e-7));
    EXPECT_FALSE(grid_for(box(-1e6, 1e6), 1e-4));
    for (const double half : {0.0, 0.3, 1e3, 1e6, 1e9, 1e15}) {
        const double finest = finest_tolerance(box(-half, half));
        EXPECT_TRUE(grid_for(box(-half, half), finest)) << half;
        EXPECT_FALSE(grid_for(box(-half, half), finest / 2)) << half;
    }
}

TEST(Quantize, KeepsTheToleranceOnEveryAxis) {
    std::mt19937_64 random(7);
    core::MeshData mesh;
    for (int i = 0; i < 20000; ++i) {
        const auto next = [&](double width) {
            return width * static_cast<double>(random() >> 11) * 0x1p-53;
        };
        mesh.vertices.push_back({500000 + next(3e4), 4650000 + next(3e4), next(4000) - 200});
    }
    for (const double unit : {1.0, 1200.0 / 3937.0}) {
        for (const double tolerance : {5.0, 0.005, 1e-4}) {
            const auto grid = grid_for(in_metres(bounds_of(mesh), unit), tolerance);
            ASSERT_TRUE(grid);
            for (const double error : quantize(mesh, unit, *grid).axis_error) {
                EXPECT_LE(error, grid->step() / 2 * (1 + 1e-6));
                EXPECT_LE(error, tolerance);
                EXPECT_GT(error, grid->step() / 2 * 0.99) << "the error is measured, so near half";
            }
        }
    }
}

TEST(CheckPlan, CountsInIntegers) {
    const std::int32_t far = kGridLimit;
    const std::vector<GridPoint> points{{0, 0, 0},       {1, 0, 5},     {0, 1, 5},
                                        {-far, -far, 0}, {far, far, 0}, {far, far - 1, 0}};
    EXPECT_EQ(check_plan(points, {{{0, 1, 2}}}).flipped, 0u);
    const std::vector<std::array<std::uint32_t, 3>> triangles{
        {0, 1, 2}, {0, 2, 1}, {3, 0, 4}, {3, 5, 4}, {3, 4, 5}};
    const PlanCheck check = check_plan(points, triangles);
    EXPECT_EQ(check.flipped, 2u);
    EXPECT_EQ(check.collapsed, 1u);
}

Box<std::int32_t> interval(std::int32_t low, std::int32_t high) {
    return {{low, 0, 0}, {high, 1, 1}};
}

TEST(Tiles, AreAsFewAsAnAxisAllows) {
    std::vector<Box<std::int32_t>> boxes;
    for (std::int32_t i = 0; i < 100; ++i)
        boxes.push_back(interval(10 * i, 10 * i + 10));
    const Tiling tiling = split_into_tiles(boxes, 250);
    EXPECT_EQ(tiling.tiles.size(), 4u);
    EXPECT_TRUE(tiling.too_large.empty());
    EXPECT_EQ(split_into_tiles(boxes, 1000).tiles.size(), 1u);
    EXPECT_EQ(split_into_tiles({}, 1000).tiles.size(), 0u);
}

TEST(Tiles, HoldEveryItemOnceAndWithinTheSpan) {
    std::mt19937 random(3);
    const std::int32_t span = 1 << 23;
    std::vector<Box<std::int32_t>> boxes;
    for (int i = 0; i < 5000; ++i) {
        Box<std::int32_t>& made = boxes.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            made.low[axis] = static_cast<std::int32_t>(random() % (1U << 27)) - (1 << 26);
            made.high[axis] = made.low[axis] + static_cast<std::int32_t>(random() % (1U << 22));
        }
    }
    boxes[17].high[1] = boxes[17].low[1] + span / 2 + 1;
    const Tiling tiling = split_into_tiles(boxes, span);
    EXPECT_EQ(tiling.too_large, std::vector<std::uint32_t>{17});
    std::vector<int> seen(boxes.size());
    for (const auto& tile : tiling.tiles) {
        ASSERT_FALSE(tile.empty());
        EXPECT_TRUE(std::is_sorted(tile.begin(), tile.end()));
        Box<std::int32_t> whole;
        for (const std::uint32_t item : tile) {
            ++seen[item];
            whole.add(boxes[item].low);
            whole.add(boxes[item].high);
        }
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_LE(whole.high[axis] - whole.low[axis], span);
    }
    seen[17] = 1;
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ssize(seen));
    EXPECT_EQ(split_into_tiles(boxes, span).tiles, tiling.tiles);
}

}  // namespace
}  // namespace tinsmith::api
