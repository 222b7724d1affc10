// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/repair.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/mesh/build.hpp"

namespace tinsmith::core {
namespace {

using Indices = std::vector<std::size_t>;

const Repair* find(const Repaired& repaired, RepairKind kind) {
    for (const Repair& repair : repaired.repairs)
        if (repair.kind == kind) return &repair;
    return nullptr;
}

/// Two triangles of a square.
MeshData square() {
    return {{{0, 0, 0}, {4, 0, 1}, {4, 4, 2}, {0, 4, 3}}, {{0, 1, 2}, {0, 2, 3}}, {}};
}

TEST(Repair, LeavesASoundMeshAlone) {
    MeshData mesh = square();
    const Repaired repaired = repair_mesh(mesh, 0.5);
    EXPECT_TRUE(repaired.repairs.empty());
    EXPECT_EQ(mesh.vertices, square().vertices);
    EXPECT_EQ(mesh.triangles, square().triangles);
    EXPECT_EQ(repaired.vertices, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST(Repair, WeldsEqualPositionsWithoutATolerance) {
    MeshData mesh = square();
    mesh.vertices.push_back({0, -0.0, 0});         // 4: vertex 0, by the other nought
    mesh.vertices.push_back({4, 4, 2.000000001});  // 5: almost vertex 2
    mesh.triangles[1] = {4, 2, 3};
    const Repaired repaired = repair_mesh(mesh, 0.0);
    const Repair* welded = find(repaired, RepairKind::VerticesWelded);
    ASSERT_NE(welded, nullptr);
    EXPECT_EQ(welded->indices, Indices{4});
    EXPECT_EQ(find(repaired, RepairKind::VerticesUnused)->indices, Indices{5});
    EXPECT_EQ(mesh.triangles, square().triangles);
    EXPECT_TRUE(build_tin(mesh));
}

TEST(Repair, WeldsWithinTheToleranceInPlanAndElevation) {
    MeshData mesh = square();
    mesh.vertices.push_back({0.006, 0.008, 0.01});  // 4: 0.01 from vertex 0 in plan, 0.01 above
    mesh.vertices.push_back({4, 4, 2.02});          // 5: above vertex 2
    mesh.triangles[1] = {4, 5, 3};
    MeshData finer = mesh;
    const Repaired repaired = repair_mesh(mesh, 0.0100001);
    EXPECT_EQ(find(repaired, RepairKind::VerticesWelded)->indices, Indices{4});
    EXPECT_EQ(mesh.vertices.size(), 5U);
    // One place with two elevations stays a fault, whatever is asked for.
    EXPECT_FALSE(build_tin(mesh, {repaired.vertices, repaired.triangles}));
    EXPECT_EQ(find(repair_mesh(finer, 0.0099), RepairKind::VerticesWelded), nullptr);
}

TEST(Repair, WeldsToTheNearestAndInNoChain) {
    // Along a line, 0.4 from each other: the third is too far from the first.
    MeshData mesh{{{0, 0, 0}, {0.4, 0, 0}, {0.8, 0, 0}, {5, 0, 0}, {0, 5, 0}, {0.5, -9, 0}},
                  {{0, 3, 4}, {0, 1, 4}, {5, 3, 2}},
                  {}};
    const Repaired repaired = repair_mesh(mesh, 0.5);
    EXPECT_EQ(find(repaired, RepairKind::VerticesWelded)->indices, Indices{1});
    EXPECT_EQ(find(repaired, RepairKind::TrianglesFlat)->indices, Indices{1});
}

TEST(Repair, TurnsDropsAndCountsByTheNumbersGiven) {
    MeshData mesh = square();
    mesh.vertices.insert(mesh.vertices.begin(), {9, 9, 9});  // 0: unused; the rest moves on
    mesh.triangles = {{1, 1, 2}, {1, 3, 2}, {1, 2, 3}, {1, 3, 4}, {3, 4, 1}};
    const Repaired repaired = repair_mesh(mesh, 0.0);
    EXPECT_EQ(find(repaired, RepairKind::TrianglesFlat)->indices, Indices{0});
    EXPECT_EQ(find(repaired, RepairKind::TrianglesTurned)->indices, Indices{1});
    EXPECT_EQ(find(repaired, RepairKind::TrianglesRepeated)->indices, (Indices{2, 4}));
    EXPECT_EQ(find(repaired, RepairKind::VerticesUnused)->indices, Indices{0});
    EXPECT_EQ(repaired.vertices, (std::vector<std::uint32_t>{1, 2, 3, 4}));
    EXPECT_EQ(repaired.triangles, (std::vector<std::uint32_t>{1, 3}));
    EXPECT_EQ(mesh.triangles, square().triangles);
}

TEST(Repair, TellsTheFirstOfManyAndCountsAll) {
    MeshData mesh = square();
    for (int i = 0; i < 25; ++i)
        mesh.vertices.push_back({100.0 + i, 0, 0});
    const Repaired repaired = repair_mesh(mesh, 0.0);
    const Repair* unused = find(repaired, RepairKind::VerticesUnused);
    EXPECT_EQ(unused->count, 25U);
    EXPECT_EQ(unused->indices.size(), Repair::kFirst);
    EXPECT_EQ(unused->indices.front(), 4U);
}

TEST(Repair, LeavesWhatCannotBeMendedToTheBuilder) {
    for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), 1e300}) {
        MeshData mesh = square();
        mesh.vertices[2].z = wrong;
        mesh.triangles.push_back({0, 0, 0});
        EXPECT_TRUE(repair_mesh(mesh, 1.0).repairs.empty());
        EXPECT_FALSE(build_tin(mesh));
    }
    MeshData mesh = square();
    mesh.triangles.push_back({0, 1, 99});
    EXPECT_TRUE(repair_mesh(mesh, 1.0).repairs.empty());
    EXPECT_EQ(mesh.triangles.size(), 3U);
    MeshData empty;
    EXPECT_TRUE(repair_mesh(empty, 1.0).repairs.empty());
}

TEST(Repair, KeepsConstraintsThatAreStillEdges) {
    MeshData mesh = square();
    mesh.vertices.push_back({0, 0, 0});
    mesh.vertices.push_back({7, 7, 7});
    mesh.constraints = {{4, 2}, {4, 0}, {2, 5}, {1, 3}};
    const Repaired repaired = repair_mesh(mesh, 0.0);
    // One that was no edge before is none now, and is left to the builder.
    EXPECT_EQ(mesh.constraints, (std::vector<std::array<std::uint32_t, 2>>{{0, 2}, {1, 3}}));
    EXPECT_FALSE(repaired.repairs.empty());
}

TEST(Repair, DropsConstraintsAlongEdgesOfFlatTrianglesAlone) {
    // Two flat triangles share the edge 0-4, which a constraint runs along; a neighbour that is not
    // flat has the edge 0-1.
    MeshData mesh = square();
    mesh.vertices.push_back({5, 0, 1});
    mesh.vertices.push_back({7, 0, 1});
    mesh.triangles.push_back({0, 4, 1});
    mesh.triangles.push_back({0, 5, 4});
    mesh.constraints = {{0, 4}, {1, 0}, {0, 2}};
    mesh.triangles.push_back({0, 6, 4});
    mesh.vertices.push_back({6, -5, 1});
    mesh.triangles.back() = {5, 6, 4};
    const Repaired repaired = repair_mesh(mesh, 0.0);
    EXPECT_EQ(find(repaired, RepairKind::TrianglesFlat)->count, 2U);
    EXPECT_EQ(mesh.constraints.size(), 2U);
    EXPECT_EQ(mesh.constraints[0], (std::array<std::uint32_t, 2>{1, 0}));
}

TEST(Repair, FindsWeldsAcrossTheCellsOfItsGrid) {
    // Pairs all over the place, each 0.9 tolerances apart in some direction.
    MeshData mesh;
    for (int i = 0; i < 400; ++i) {
        const double x = i % 20 * 3.17, y = i / 20 * 3.17;
        const double turn = i * 0.7;
        mesh.vertices.push_back({x, y, 0});
        mesh.vertices.push_back({x + 0.09 * std::cos(turn), y + 0.09 * std::sin(turn), 0.05});
    }
    for (std::uint32_t i = 0; i + 6 < mesh.vertices.size(); i += 2)
        mesh.triangles.push_back({i, i + 2, i + 5});
    EXPECT_EQ(find(repair_mesh(mesh, 0.1), RepairKind::VerticesWelded)->count, 400U);
}

}  // namespace
}  // namespace tinsmith::core
