// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/grid_build.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/mesh/build.hpp"
#include "core/mesh/check.hpp"
#include "core/mesh/grid_builder.hpp"
#include "core/types/range.hpp"
#include "tests/support/same_state.hpp"

namespace tinsmith::core {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kAny = kMaxTriangles;

/// A grid's triangles as plain buffers, written down without the tables that the builder goes by.
MeshData plain(const PostGrid& grid) {
    const auto z = [&](std::size_t post) { return grid.elevations[post]; };
    std::vector<std::array<std::size_t, 3>> triangles;
    for (std::size_t r = 0; r + 1 < grid.rows; ++r) {
        for (std::size_t c = 0; c + 1 < grid.columns; ++c) {
            const std::size_t south = (grid.dy > 0 ? r : r + 1) * grid.columns;
            const std::size_t north = (grid.dy > 0 ? r + 1 : r) * grid.columns;
            const std::size_t west = grid.dx > 0 ? c : c + 1, east = grid.dx > 0 ? c + 1 : c;
            const std::size_t sw = south + west, se = south + east;
            const std::size_t ne = north + east, nw = north + west;
            const bool has_sw = !std::isnan(z(sw)), has_se = !std::isnan(z(se));
            const bool has_ne = !std::isnan(z(ne)), has_nw = !std::isnan(z(nw));
            if (has_sw && has_se && has_ne && has_nw) {
                if (std::fabs(z(sw) - z(ne)) <= std::fabs(z(se) - z(nw))) {
                    triangles.push_back({sw, se, ne});
                    triangles.push_back({sw, ne, nw});
                } else {
                    triangles.push_back({sw, se, nw});
                    triangles.push_back({se, ne, nw});
                }
                continue;
            }
            if (has_se && has_ne && has_nw) triangles.push_back({se, ne, nw});
            if (has_sw && has_ne && has_nw) triangles.push_back({sw, ne, nw});
            if (has_sw && has_se && has_nw) triangles.push_back({sw, se, nw});
            if (has_sw && has_se && has_ne) triangles.push_back({sw, se, ne});
        }
    }
    std::vector<std::uint32_t> number(grid.elevations.size(), UINT32_MAX);
    for (const auto& triangle : triangles)
        for (const std::size_t post : triangle)
            number[post] = 0;
    MeshData mesh;
    for (std::size_t post = 0; post < number.size(); ++post) {
        if (number[post] != 0) continue;
        number[post] = static_cast<std::uint32_t>(mesh.vertices.size());
        const auto column = static_cast<double>(post % grid.columns);
        const auto row = static_cast<double>(post / grid.columns);
        mesh.vertices.push_back(
            {grid.origin.x + column * grid.dx, grid.origin.y + row * grid.dy, z(post)});
    }
    for (const auto& [a, b, c] : triangles)
        mesh.triangles.push_back({number[a], number[b], number[c]});
    return mesh;
}

/// Empty where both ways lead to the same: the same mesh, or none.
std::string difference(const PostGrid& grid) {
    const auto expected = build_tin(plain(grid));
    const auto built = build_tin_of_grid(grid, kAny);
    if (!expected.ok()) return built ? "a mesh where there is none" : "";
    if (!built) return "no mesh";
    if (const int member = test::differing_member(*expected, *built); member >= 0)
        return "member " + std::to_string(member) + " differs";
    if (!check_tin(*built).empty()) return check_tin(*built)[0].detail;
    // In many bands, each a row or so, the last one first.
    const Executor backwards = [](std::span<const Job> jobs) {
        for (std::size_t i = jobs.size(); i-- > 0;)
            jobs[i]();
    };
    const auto banded = GridBuilder(grid, kAny, backwards, 1).build();
    if (!banded) return "no mesh in bands";
    const int member = test::differing_member(*expected, *banded);
    return member < 0 ? "" : "member " + std::to_string(member) + " differs in bands";
}

std::string shown(const PostGrid& grid) {
    std::string text = std::to_string(grid.dx) + " " + std::to_string(grid.dy);
    for (std::size_t i = 0; i < grid.elevations.size(); ++i)
        text += (i % grid.columns == 0 ? "\n" : " ") + std::to_string(grid.elevations[i]);
    return text;
}

/// All four ways in which a grid may be stored.
std::vector<PostGrid> all_ways(PostGrid grid) {
    std::vector<PostGrid> ways;
    for (const double dx : {1.25, -1.25})
        for (const double dy : {-0.75, 0.75}) {
            grid.dx = dx;
            grid.dy = dy;
            ways.push_back(grid);
        }
    return ways;
}

void expect_the_same(const PostGrid& grid) {
    for (const PostGrid& way : all_ways(grid))
        ASSERT_EQ(difference(way), "") << shown(way);
}

/// Rows of digits; a dot is a post without data.
PostGrid drawn(const std::vector<std::string>& rows) {
    PostGrid grid{{100, 200}, 1, 1, rows.front().size(), rows.size(), {}};
    for (const std::string& row : rows)
        for (const char c : row)
            grid.elevations.push_back(c == '.' ? kHole : c - '0');
    return grid;
}

PostGrid random_grid(std::mt19937& random, std::size_t columns, std::size_t rows, double holes) {
    PostGrid grid{{-3, 7}, 1, 1, columns, rows, {}};
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::uniform_int_distribution<int> height(-3, 3);
    for (std::size_t i = 0; i < columns * rows; ++i) {
        // Few heights, so that diagonals tie; zeros of both signs.
        const double z = height(random) * (share(random) < 0.5 ? 1.0 : -1.0);
        grid.elevations.push_back(share(random) < holes ? kHole : z);
    }
    return grid;
}

TEST(GridBuild, WholeGridsOfEverySmallSize) {
    std::mt19937 random(1);
    for (std::size_t columns = 2; columns <= 6; ++columns)
        for (std::size_t rows = 2; rows <= 6; ++rows)
            for (int i = 0; i < 10; ++i)
                expect_the_same(random_grid(random, columns, rows, 0.0));
}

TEST(GridBuild, EveryPatternOfHolesInThreeByThree) {
    for (unsigned holes = 0; holes < 512; ++holes) {
        PostGrid grid{{0, 0}, 1, 1, 3, 3, {1, 5, 2, 8, 3, 7, 4, 6, 9}};
        for (unsigned i = 0; i < 9; ++i)
            if ((holes >> i & 1U) != 0) grid.elevations[i] = kHole;
        expect_the_same(grid);
    }
}

TEST(GridBuild, HolesAnywhere) {
    std::mt19937 random(2);
    for (const double holes : {0.02, 0.1, 0.3, 0.5, 0.7})
        for (std::size_t columns = 2; columns <= 9; ++columns)
            for (std::size_t rows = 2; rows <= 9; ++rows)
                for (int i = 0; i < 3; ++i)
                    expect_the_same(random_grid(random, columns, rows, holes));
}

/// So wide that cells and posts are written in runs, which holes break.
TEST(GridBuild, WideGridsWithAndWithoutHoles) {
    std::mt19937 random(3);
    for (const double holes : {0.0, 0.001, 0.005, 0.02})
        for (const std::size_t columns : {20U, 41U, 97U, 300U})
            for (const std::size_t rows : {2U, 3U, 4U, 30U})
                expect_the_same(random_grid(random, columns, rows, holes));
}

TEST(GridBuild, MoreCellsThanABandHas) {
    std::mt19937 random(4);
    for (const double holes : {0.0, 1e-4}) {
        PostGrid grid = random_grid(random, 901, 601, holes);
        grid.dy = -1.0;
        ASSERT_EQ(difference(grid), "");
    }
}

TEST(GridBuild, PartsThatTouchInPosts) {
    expect_the_same(drawn({"12...", "34...", "..56.", "..78.", "....."}));
    expect_the_same(drawn({"12.", "345", ".67"}));
    expect_the_same(drawn({".12", "345", "67."}));
    expect_the_same(drawn({"12.34", "56789", "..1..", "23456", "78.91"}));
    // Four fans in one post, each of one triangle.
    expect_the_same(drawn({".1.2.", "34567", ".8.9.", "12345", ".6.7."}));
}

TEST(GridBuild, SeveralComponentsAndOddPosts) {
    expect_the_same(drawn({"12.12.3", "34.34..", "......9", "12.12..", "34.345."}));
    expect_the_same(drawn({"1234567", "7......", "1.12345", "2......", "1234567"}));
    // A ring around a hole, and an island within it.
    expect_the_same(drawn({"1111111", "1.....1", "1.222.1", "1.222.1", "1.....1", "1111111"}));
    expect_the_same(drawn({"1111111", "1122211", "11...11", "11.2.11", "11...11", "1111111"}));
}

TEST(GridBuild, BoundsOfZerosHaveTheFirstOnesSign) {
    expect_the_same({{0, 0}, 1, 1, 2, 2, {0.0, -0.0, 0.0, -0.0}});
    expect_the_same({{0, 0}, 1, 1, 2, 2, {-0.0, 0.0, 1.0, 2.0}});
    expect_the_same({{-0.0, -0.0}, 1, 1, 3, 2, {kHole, -1.0, -0.0, 0.0, -0.0, -3.0}});
    expect_the_same({{-2.5, 1.5}, 1, 1, 4, 4, {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}});
    // Amid whole cells, as the lowest and as the highest.
    for (const double sign : {1.0, -1.0})
        for (const double rim : {1.0, -1.0}) {
            PostGrid grid{{0, 0}, 1, 1, 4, 4, std::vector<double>(16, rim)};
            grid.elevations[5] = grid.elevations[10] = sign * 0.0;
            grid.elevations[6] = grid.elevations[9] = -sign * 0.0;
            expect_the_same(grid);
        }
}

/// Where posts fall together both ways lead to none.
TEST(GridBuild, PlacesWhereDoublesRound) {
    std::mt19937 random(5);
    int meshes = 0, none = 0;
    for (const double far : {1e6 + 1.0 / 3.0, -4.7e8, 9.1e14}) {
        for (const double step : {1.0 / 3.0, 0.1, 1e-3, 1e-9, 30.7}) {
            PostGrid grid = random_grid(random, 19, 11, 0.0);
            grid.origin = {far, -far};
            grid.dx = step;
            grid.dy = -step;
            EXPECT_EQ(difference(grid), "") << far << " " << step;
            ++(build_tin_of_grid(grid, kAny) ? meshes : none);
        }
    }
    EXPECT_EQ(meshes, 11);
    EXPECT_EQ(none, 4);
}

TEST(GridBuild, NothingWhereTheShapeProvesNothing) {
    const std::vector<double> four{1, 2, 3, 4};
    ASSERT_TRUE(build_tin_of_grid({{0, 0}, 1, 1, 2, 2, four}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{0, 0}, 0, 1, 2, 2, four}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{0, 0}, 1, kHole, 2, 2, four}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{kHole, 0}, 1, 1, 2, 2, four}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{0, 0}, HUGE_VAL, 1, 2, 2, four}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{1e9, 0}, 1e-9, 1, 2, 2, four}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{0, 1e9}, 1, -1e-9, 2, 2, four}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{1.0, 0}, 2e15, 1, 2, 2, four}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{1e-70, 0}, 1, 1, 2, 2, four}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{0, 0}, 1, 1e-70, 2, 2, four}, kAny));
}

TEST(GridBuild, NothingOfElevationsThatTheCoreRefuses) {
    for (const double bad : {HUGE_VAL, -HUGE_VAL, 2e15, -2e15, 1e-70, -1e-70}) {
        for (std::size_t i = 0; i < 6; ++i) {
            PostGrid grid{{0, 0}, 1, 1, 3, 2, {1, 2, 3, 4, 5, 6}};
            grid.elevations[i] = bad;
            EXPECT_FALSE(build_tin_of_grid(grid, kAny)) << bad << " at " << i;
            EXPECT_FALSE(build_tin(plain(grid)).ok()) << bad << " at " << i;
        }
    }
}

TEST(GridBuild, NothingWithoutTrianglesOrWithTooMany) {
    EXPECT_FALSE(build_tin_of_grid({}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{0, 0}, 1, 1, 1, 4, {1, 2, 3, 4}}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{0, 0}, 1, 1, 4, 1, {1, 2, 3, 4}}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{0, 0}, 1, 1, 2, 2, {1, kHole, kHole, 4}}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{0, 0}, 1, 1, 2, 2, {kHole, kHole, kHole, kHole}}, kAny));
    const PostGrid two{{0, 0}, 1, 1, 2, 2, {1, 2, 3, 4}};
    EXPECT_FALSE(build_tin_of_grid(two, 1));
    EXPECT_TRUE(build_tin_of_grid(two, 2));
    // As many elevations as columns and rows say, modulo 2^64 too.
    EXPECT_FALSE(build_tin_of_grid({{0, 0}, 1, 1, 2, 2, {1, 2, 3}}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{0, 0}, 1, 1, 2, 2, {1, 2, 3, 4, 5}}, kAny));
    EXPECT_FALSE(build_tin_of_grid({{0, 0}, 1, 1, std::size_t{1} << 63, 2, {}}, kAny));
    EXPECT_FALSE(
        build_tin_of_grid({{0, 0}, 1, 1, 2, (std::size_t{1} << 63) + 2, two.elevations}, kAny));
}

/// The mesh is there to be edited, with as much room as any.
TEST(GridBuild, HasRoomToGrow) {
    std::mt19937 random(6);
    const PostGrid grid = random_grid(random, 200, 100, 0.01);
    const auto expected = build_tin(plain(grid));
    const auto built = build_tin_of_grid(grid, kAny);
    ASSERT_TRUE(built);
    EXPECT_EQ(built->memory_bytes(), expected->memory_bytes());
}

}  // namespace
}  // namespace tinsmith::core
