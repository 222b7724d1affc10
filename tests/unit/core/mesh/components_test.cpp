// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/components.hpp"

#include <gtest/gtest.h>

#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

TEST(Components, OfAWholeMeshIsOne) {
    EXPECT_EQ(test::built(test::grid(4, 4)).components(), std::vector<TriangleId>{{0}});
    EXPECT_EQ(test::built(test::ring_of_cells()).components(), std::vector<TriangleId>{{0}});
}

TEST(Components, ThatTouchInOneVertexAreTwo) {
    // The lower left cell and the upper right one of four.
    MeshData data = test::grid(2, 2);
    data.triangles.erase(data.triangles.begin() + 2, data.triangles.begin() + 6);
    data.vertices.erase(data.vertices.begin() + 6);
    data.vertices.erase(data.vertices.begin() + 2);
    for (auto& t : data.triangles)
        for (auto& v : t)
            v -= (v > 2 ? 1U : 0U) + (v > 6 ? 1U : 0U);
    EXPECT_EQ(test::built(data).components(), (std::vector<TriangleId>{{0}, {2}}));
}

TEST(Components, StayThroughAnOperationACopyAndAnUndo) {
    MeshData two = test::grid(2, 2);
    for (const Point3& v : test::grid(3, 1, test::Diagonals::Rising, 1, {10, 0}).vertices)
        two.vertices.push_back(v);
    for (const auto& t : test::grid(3, 1).triangles)
        two.triangles.push_back({t[0] + 9, t[1] + 9, t[2] + 9});
    Tin tin = test::built(two);
    const std::vector<TriangleId> seeds{{0}, {8}};
    EXPECT_EQ(tin.components(), seeds);
    Undo undo;
    const Shape across = test::line({{-1, 0.25}, {20, 0.75}});
    ASSERT_TRUE(integrate(tin, {&across, 1}, {}, &undo).ok());
    EXPECT_EQ(find_components(tin), seeds);
    EXPECT_EQ(Tin(tin).components(), seeds);
    take_back(tin, undo);
    EXPECT_EQ(find_components(tin), tin.components());
}

}  // namespace
}  // namespace tinsmith::core
