// SPDX-License-Identifier: Apache-2.0
#include "api/formats/grid_mesh.hpp"

#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "api/side_by_side.hpp"
#include "core/mesh/build.hpp"
#include "tests/support/same_state.hpp"

namespace tinsmith::api {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

double doubled_area(const core::MeshData& mesh, const std::array<std::uint32_t, 3>& triangle) {
    const core::Point3& a = mesh.vertices[triangle[0]];
    const core::Point3& b = mesh.vertices[triangle[1]];
    const core::Point3& c = mesh.vertices[triangle[2]];
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

void expect_sound(const core::MeshData& mesh, double cell_area) {
    std::vector<bool> used(mesh.vertices.size(), false);
    for (const auto& triangle : mesh.triangles) {
        EXPECT_DOUBLE_EQ(doubled_area(mesh, triangle), cell_area);
        for (const std::uint32_t vertex : triangle)
            used.at(vertex) = true;
    }
    for (const bool one : used)
        EXPECT_TRUE(one);
}

TEST(GridMesh, CounterClockwiseWhateverTheSigns) {
    for (const double dx : {2.0, -2.0}) {
        for (const double dy : {3.0, -3.0}) {
            const Grid grid{{5, 7}, dx, dy, 3, 3, {0, 5, 1, kHole, 2, 8, 9, 4, 3}};
            const auto mesh = mesh_of_grid(grid, {});
            ASSERT_TRUE(mesh.ok());
            EXPECT_EQ(mesh->vertices.size(), 8U);
            EXPECT_EQ(mesh->triangles.size(), 6U);
            expect_sound(*mesh, 6.0);
            EXPECT_EQ(mesh->vertices[0], (core::Point3{5, 7, 0}));
            EXPECT_EQ(mesh->vertices[7], (core::Point3{5 + 2 * dx, 7 + 2 * dy, 3}));
        }
    }
}

/// The two vertices that both triangles of a single cell share.
std::array<core::Point3, 2> diagonal(const Grid& grid) {
    const auto mesh = mesh_of_grid(grid, {});
    std::vector<core::Point3> shared;
    for (const std::uint32_t a : mesh->triangles[0]) {
        for (const std::uint32_t b : mesh->triangles[1]) {
            if (a == b) shared.push_back(mesh->vertices[a]);
        }
    }
    EXPECT_EQ(shared.size(), 2U);
    return {shared.at(0), shared.at(1)};
}

TEST(GridMesh, TheDiagonalFollowsTheSmallerDifference) {
    // A level north-west to south-east, a step across.
    const auto level = diagonal({{0, 0}, 1, 1, 2, 2, {0, 5, 5, 9}});
    EXPECT_EQ(level[0].z, 5);
    EXPECT_EQ(level[1].z, 5);
    const auto other = diagonal({{0, 0}, 1, 1, 2, 2, {5, 0, 9, 5}});
    EXPECT_EQ(other[0].z, 5);
    EXPECT_EQ(other[1].z, 5);
}

TEST(GridMesh, OnATieTheDiagonalRunsSouthWestToNorthEast) {
    for (const double dx : {1.0, -1.0}) {
        for (const double dy : {1.0, -1.0}) {
            const auto ends = diagonal({{0, 0}, dx, dy, 2, 2, {4, 4, 4, 4}});
            EXPECT_GT((ends[1].x - ends[0].x) * (ends[1].y - ends[0].y), 0.0);
        }
    }
}

TEST(GridMesh, ThreePostsMakeOneTriangle) {
    for (std::size_t hole = 0; hole < 4; ++hole) {
        Grid grid{{0, 0}, 1, -1, 2, 2, {1, 2, 3, 4}};
        grid.elevations[hole] = kHole;
        const auto mesh = mesh_of_grid(grid, {});
        ASSERT_TRUE(mesh.ok());
        ASSERT_EQ(mesh->triangles.size(), 1U);
        expect_sound(*mesh, 1.0);
    }
}

TEST(GridMesh, IsolatedPostsAreDropped) {
    const Grid grid{{0, 0}, 1, 1, 4, 2, {1, 2, kHole, 3, 4, 5, kHole, 6}};
    const auto mesh = mesh_of_grid(grid, {});
    ASSERT_TRUE(mesh.ok());
    EXPECT_EQ(mesh->vertices.size(), 4U);
    EXPECT_EQ(mesh->triangles.size(), 2U);
}

TEST(GridMesh, Refusals) {
    EXPECT_EQ(mesh_of_grid({{0, 0}, 1, 1, 1, 2, {1, 2}}, {}).faults()[0].code, "GRID_TOO_SMALL");
    EXPECT_EQ(mesh_of_grid({{0, 0}, 1, 1, 0, 0, {}}, {}).faults()[0].code, "GRID_TOO_SMALL");
    const auto tiny = mesh_of_grid({{1e9 - 10, 0}, 1e-9, 1, 2, 2, {1, 2, 3, 4}}, {}, "/grid");
    ASSERT_FALSE(tiny.ok());
    EXPECT_EQ(tiny.faults()[0].code, "COORDINATE_OUT_OF_RANGE");
    EXPECT_EQ(tiny.faults()[0].pointer, "/grid");
    EXPECT_EQ(mesh_of_grid({{1e9, 0}, 1, 1, 2, 2, {1, 2, 3, 4}}, {}).faults()[0].code,
              "COORDINATE_OUT_OF_RANGE");
    EXPECT_EQ(mesh_of_grid({{0, 0}, kHole, 1, 2, 2, {1, 2, 3, 4}}, {}).faults()[0].code,
              "COORDINATE_OUT_OF_RANGE");
    EXPECT_EQ(mesh_of_grid({{0, 0}, 1, 1, 2, 2, {kHole, kHole, 1, 1}}, {}).faults()[0].code,
              "MESH_EMPTY");
    ReadLimits limits;
    limits.max_vertices = 3;
    EXPECT_EQ(mesh_of_grid({{0, 0}, 1, 1, 2, 2, {1, 2, 3, 4}}, limits).kind(), FaultKind::TooLarge);
    limits = {};
    limits.max_triangles = 1;
    EXPECT_EQ(mesh_of_grid({{0, 0}, 1, 1, 2, 2, {1, 2, 3, 4}}, limits).faults()[0].code,
              "TOO_MANY_TRIANGLES");
}

/// Grids of which not all are meshes, as each reader may hand them on.
std::vector<Grid> some_grids() {
    std::vector<Grid> grids;
    std::mt19937 random(1);
    std::uniform_int_distribution<int> height(0, 9), size(1, 30), one_in(0, 20);
    for (int i = 0; i < 400; ++i) {
        Grid grid{{1e5 / 3, -2e6}, i % 2 == 0 ? 0.3 : -30.0, i % 3 == 0 ? 1e-9 : -1.7, 0, 0, {}};
        grid.columns = static_cast<std::size_t>(size(random));
        grid.rows = static_cast<std::size_t>(size(random)) / 2;
        const int holes = i % 4;
        for (std::size_t post = 0; post < grid.columns * grid.rows; ++post) {
            const bool is_hole = one_in(random) < holes * holes;
            grid.elevations.push_back(is_hole ? kHole : height(random) / 7.0);
        }
        grids.push_back(std::move(grid));
    }
    return grids;
}

TEST(GridMesh, StraightToTheMeshIsTheSameMesh) {
    int same = 0, refused = 0;
    for (const Grid& grid : some_grids()) {
        const auto mesh = mesh_of_grid(grid, {});
        const auto tin = tin_of_grid(grid, {}, side_by_side);
        ASSERT_EQ(tin.has_value(), mesh.ok()) << grid.columns << " by " << grid.rows;
        ++(tin ? same : refused);
        if (!tin) continue;
        EXPECT_EQ(test::differing_member(core::build_tin(*mesh).value(), *tin), -1);
    }
    EXPECT_GT(same, 200);
    EXPECT_GT(refused, 20);
}

TEST(GridMesh, StraightToTheMeshWithinTheSameLimits) {
    const Grid grid{{0, 0}, 1, 1, 3, 2, {1, 2, 3, 4, kHole, 6}};
    for (std::size_t most = 0; most < 8; ++most) {
        ReadLimits limits;
        limits.max_vertices = most;
        EXPECT_EQ(tin_of_grid(grid, limits).has_value(), mesh_of_grid(grid, limits).ok()) << most;
        limits = {};
        limits.max_triangles = most;
        EXPECT_EQ(tin_of_grid(grid, limits).has_value(), mesh_of_grid(grid, limits).ok()) << most;
    }
}

TEST(GridMesh, OnlyGridsAreMeshed) {
    Terrain terrain;
    terrain.name = "of a grid";
    terrain.grid = Grid{{0, 0}, 1, 1, 2, 2, {1, 2, 3, 4}};
    const auto meshed_terrain = meshed(terrain, {});
    ASSERT_TRUE(meshed_terrain.ok());
    EXPECT_FALSE(meshed_terrain->grid);
    EXPECT_EQ(meshed_terrain->name, "of a grid");
    EXPECT_EQ(meshed_terrain->mesh.triangles.size(), 2U);
    EXPECT_EQ(meshed(*meshed_terrain, {})->mesh.triangles, meshed_terrain->mesh.triangles);
    terrain.grid->columns = terrain.grid->rows = 0;
    EXPECT_EQ(meshed(terrain, {}).faults()[0].code, "GRID_TOO_SMALL");
    const Parsed<Terrain> refused(FaultKind::Syntax, Fault{"TIFF_SYNTAX", "no TIFF", {}});
    EXPECT_EQ(meshed(refused, {}).faults()[0].code, "TIFF_SYNTAX");
}

}  // namespace
}  // namespace tinsmith::api
