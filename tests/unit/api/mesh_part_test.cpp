// SPDX-License-Identifier: Apache-2.0
#include "api/mesh_part.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "api/edge_chains.hpp"

namespace tinsmith::api {
namespace {

using Slots = std::vector<std::uint32_t>;

/// Two triangles of the square of 10, one beyond its right side.
core::MeshData square() {
    core::MeshData mesh;
    mesh.vertices = {{0, 0, 0}, {10, 0, 1}, {10, 10, 2}, {0, 10, 3}, {20, 0, 4}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}};
    mesh.constraints = {{0, 2}, {1, 2}, {3, 0}};
    return mesh;
}

TEST(MeshPart, TakesTrianglesThatMeetTheClosedBox) {
    const core::MeshData mesh = square();
    EXPECT_EQ(part_within(mesh, {6, 1, 7, 2}).triangles, (Slots{0}));
    EXPECT_EQ(part_within(mesh, {5, 5, 5, 5}).triangles, (Slots{0, 1})) << "on the edge";
    EXPECT_EQ(part_within(mesh, {10, 10, 30, 30}).triangles, (Slots{0, 1, 2})) << "a corner";
    EXPECT_EQ(part_within(mesh, {-5, -5, 30, 30}).triangles, (Slots{0, 1, 2}));
    EXPECT_EQ(part_within(mesh, {10.5, 9.6, 12, 12}).triangles, (Slots{}))
        << "within the box of the third, beyond its side";
    EXPECT_EQ(part_within(mesh, {20, 0, 20, 0}).triangles, (Slots{2}));
    EXPECT_EQ(part_within(mesh, {20, -3, 30, std::nextafter(0.0, -1.0)}).triangles, (Slots{}));
    EXPECT_EQ(part_within(mesh, {11, 9, 11, 9}).triangles, (Slots{2})) << "exactly on its side";
    EXPECT_EQ(part_within(mesh, {std::nextafter(11, 12), 9, 11.5, 9}).triangles, (Slots{}));
}

TEST(MeshPart, IsAMeshOfItsOwn) {
    const MeshPart part = part_within(square(), {0, 9, 1, 10});
    EXPECT_EQ(part.triangles, (Slots{1}));
    ASSERT_EQ(part.mesh.vertices.size(), 3U);
    EXPECT_EQ(part.mesh.vertices[1].z, 2.0) << "vertices keep their order";
    EXPECT_EQ(part.mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
    EXPECT_EQ(part.mesh.constraints, (std::vector<std::array<std::uint32_t, 2>>{{0, 1}, {2, 0}}))
        << "the edges of its triangle, also with the ends in another order";
}

TEST(EdgeChains, JoinEdgesToLines) {
    const std::vector<std::array<std::uint32_t, 2>> edges{{1, 2}, {5, 4}, {3, 2}, {4, 3},
                                                          {7, 8}, {8, 9}, {9, 7}, {2, 6}};
    const auto lines = chain_edges(edges);
    ASSERT_EQ(lines.size(), 4U);
    EXPECT_EQ(lines[0], (Slots{1, 2})) << "three edges meet at 2";
    EXPECT_EQ(lines[1], (Slots{5, 4, 3, 2}));
    EXPECT_EQ(lines[2].size(), 4U) << "a ring";
    EXPECT_EQ(lines[2].front(), lines[2].back());
    EXPECT_EQ(lines[3], (Slots{2, 6}));
}

TEST(EdgeChains, EndWhereTheGroupDoes) {
    const std::vector<std::array<std::uint32_t, 2>> edges{{0, 1}, {1, 2}, {2, 3}};
    const auto lines = chain_edges(edges, [](std::size_t edge) { return edge < 2 ? 0U : 1U; });
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0], (Slots{0, 1, 2}));
    EXPECT_EQ(lines[1], (Slots{2, 3}));
}

}  // namespace
}  // namespace tinsmith::api
