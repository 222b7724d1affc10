// SPDX-License-Identifier: Apache-2.0
#include "core/types/ids.hpp"

#include <type_traits>

#include <gtest/gtest.h>

namespace tinsmith::core {
namespace {

TEST(Ids, AreInvalidUntilGivenAValue) {
    EXPECT_FALSE(VertexId{}.valid());
    EXPECT_FALSE(TriangleId{}.valid());
    EXPECT_FALSE(Side{}.valid());
    EXPECT_TRUE(VertexId{0}.valid());
    EXPECT_TRUE(TriangleId{0}.valid());
    EXPECT_TRUE(Side({0}, 0).valid());
}

TEST(Ids, OfVerticesAndTrianglesDoNotMix) {
    EXPECT_FALSE((std::is_convertible_v<VertexId, TriangleId>));
    EXPECT_FALSE((std::is_convertible_v<VertexId, std::uint32_t>));
    EXPECT_FALSE((std::is_convertible_v<std::uint32_t, Side>));
}

TEST(Side, NamesItsTriangleAndIndex) {
    for (const std::uint32_t t : {0U, 1U, 77U, static_cast<std::uint32_t>(kMaxTriangles - 1)}) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side(TriangleId{t}, i);
            EXPECT_TRUE(side.valid());
            EXPECT_EQ(side.triangle(), TriangleId{t});
            EXPECT_EQ(side.index(), i);
        }
    }
}

TEST(Side, GoesAroundItsTriangleInThreeSteps) {
    for (unsigned i = 0; i < 3; ++i) {
        const Side side({5}, i);
        EXPECT_EQ(side.next().index(), (i + 1) % 3);
        EXPECT_EQ(side.previous().index(), (i + 2) % 3);
        EXPECT_EQ(side.next().previous(), side);
        EXPECT_EQ(side.next().next().next(), side);
        EXPECT_EQ(side.next().triangle(), side.triangle());
    }
}

TEST(Side, IsOrderedByTriangleThenIndex) {
    EXPECT_LT(Side({1}, 0), Side({1}, 2));
    EXPECT_LT(Side({1}, 2), Side({2}, 0));
}

}  // namespace
}  // namespace tinsmith::core
