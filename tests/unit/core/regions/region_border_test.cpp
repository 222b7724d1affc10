// SPDX-License-Identifier: Apache-2.0
#include "core/regions/region_border.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "core/mesh/build.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

/// A square lattice of n x n cells, two triangles each: cell (i, j) has 2 * (j * n + i) and the
/// next.
Tin lattice(std::uint32_t n) {
    MeshData data;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i)
            data.vertices.push_back({double(i), double(j), 0.0});
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i;
            data.triangles.push_back({a, a + 1, a + n + 2});
            data.triangles.push_back({a, a + n + 2, a + n + 1});
        }
    }
    return *build_tin(data);
}

std::vector<TriangleId> cells(std::uint32_t n,
                              std::initializer_list<std::array<std::uint32_t, 2>> all) {
    std::vector<TriangleId> triangles;
    for (const auto& [i, j] : all) {
        triangles.push_back(TriangleId{2 * (j * n + i)});
        triangles.push_back(TriangleId{2 * (j * n + i) + 1});
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

double area_of(const Tin& tin, const std::vector<VertexId>& ring) {
    double sum = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2 p = tin.plan(ring[i]), q = tin.plan(ring[(i + 1) % ring.size()]);
        sum += (p.x * q.y - p.y * q.x) / 2;
    }
    return sum;
}

/// Each ring is simple; outer ones turn left, holes right; together they have the triangles' area.
void expect_sound(const Tin& tin, const std::vector<TriangleId>& triangles,
                  const std::vector<BorderedPart>& parts) {
    double area = 0.0, wanted = 0.0;
    for (const BorderedPart& part : parts) {
        EXPECT_GT(area_of(tin, part.outer), 0.0);
        area += area_of(tin, part.outer);
        std::vector<std::vector<VertexId>> rings = part.holes;
        for (const auto& hole : part.holes) {
            EXPECT_LT(area_of(tin, hole), 0.0);
            area += area_of(tin, hole);
        }
        rings.push_back(part.outer);
        for (const auto& ring : rings) {
            EXPECT_GE(ring.size(), 3U);
            EXPECT_EQ(std::set<VertexId>(ring.begin(), ring.end()).size(), ring.size());
        }
    }
    for (const TriangleId t : triangles) {
        const auto& v = tin.triangle(t).vertices;
        wanted += area_of(tin, {v[0], v[1], v[2]});
    }
    EXPECT_NEAR(area, wanted, 1e-9 * wanted);
}

TEST(RegionBorder, OfACellIsItsSquare) {
    const Tin tin = lattice(3);
    const auto triangles = cells(3, {{1, 1}});
    const auto parts = border_of(tin, triangles);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].outer.size(), 4U);
    EXPECT_TRUE(parts[0].holes.empty());
    expect_sound(tin, triangles, parts);
    EXPECT_TRUE(border_of(tin, {}).empty());
}

TEST(RegionBorder, HasHolesAndParts) {
    const Tin tin = lattice(5);
    // A frame around the cell (1, 1), and a cell by itself that touches the frame's corner.
    const auto triangles =
        cells(5, {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {2, 1}, {0, 2}, {1, 2}, {2, 2}, {3, 3}});
    const auto parts = border_of(tin, triangles);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0].outer.size(), 12U);
    ASSERT_EQ(parts[0].holes.size(), 1U);
    EXPECT_EQ(parts[0].holes[0].size(), 4U);
    EXPECT_EQ(parts[1].outer.size(), 4U);
    expect_sound(tin, triangles, parts);
}

TEST(RegionBorder, RingsThatTouchAreApart) {
    const Tin tin = lattice(4);
    // Two holes that meet at the lattice's middle; and one that touches the outside at a corner.
    const auto twice = cells(4, {{0, 0},
                                 {1, 0},
                                 {2, 0},
                                 {3, 0},
                                 {0, 1},
                                 {2, 1},
                                 {3, 1},
                                 {0, 2},
                                 {1, 2},
                                 {3, 2},
                                 {0, 3},
                                 {1, 3},
                                 {2, 3},
                                 {3, 3}});
    auto parts = border_of(tin, twice);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].holes.size(), 2U);
    expect_sound(tin, twice, parts);
    const auto corner = cells(4, {{1, 0}, {2, 0}, {0, 1}, {2, 1}, {0, 2}, {1, 2}, {2, 2}});
    parts = border_of(tin, corner);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].holes.size(), 1U);
    expect_sound(tin, corner, parts);
}

TEST(RegionBorder, RingsThatTouchAreApartWhereAPlaceHasTwoVertices) {
    // As `remove` leaves it: two holes that touch at the middle, which is a vertex of either side.
    MeshData data = lattice(4).to_data();
    const std::uint32_t middle = 12, other = 25;
    data.vertices.push_back(data.vertices[middle]);
    std::vector<std::array<std::uint32_t, 3>> kept;
    for (std::uint32_t t = 0; t < data.triangles.size(); ++t) {
        const std::uint32_t i = t / 2 % 4, j = t / 8;
        if ((i == 1 && j == 1) || (i == 2 && j == 2)) continue;
        auto corners = data.triangles[t];
        if (i == 2 && j == 1) std::replace(corners.begin(), corners.end(), middle, other);
        kept.push_back(corners);
    }
    data.triangles = std::move(kept);
    const auto tin = build_tin(data);
    ASSERT_TRUE(tin);
    std::vector<TriangleId> all;
    for (std::uint32_t t = 0; t < tin->triangle_count(); ++t)
        all.push_back(TriangleId{t});
    const auto parts = border_of(*tin, all);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].outer.size(), 16U);
    ASSERT_EQ(parts[0].holes.size(), 2U);
    EXPECT_EQ(parts[0].holes[0].size(), 4U);
    EXPECT_EQ(parts[0].holes[1].size(), 4U);
    expect_sound(*tin, all, parts);
}

TEST(RegionBorder, IsSoundForAnyTriangles) {
    const Tin tin = lattice(12);
    std::uint32_t state = 7;
    for (int round = 0; round < 200; ++round) {
        std::vector<TriangleId> triangles;
        for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
            state = state * 1664525U + 1013904223U;
            if ((state >> 24) % 8 < static_cast<unsigned>(round % 8))
                triangles.push_back(TriangleId{t});
        }
        expect_sound(tin, triangles, border_of(tin, triangles));
    }
}

TEST(RegionBorder, PassesOverSlits) {
    // Vertices 5 and 6 are in one place: between 4 and 7 the mesh is parted along a line.
    const Tin tin = *build_tin(
        {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 2, 0}, {2, 2, 0}, {2, 2, 0}, {3, 2, 0}},
         {{0, 1, 5}, {0, 5, 4}, {1, 7, 5}, {1, 2, 7}, {2, 6, 7}, {2, 3, 6}, {3, 4, 6}, {3, 0, 4}},
         {}});
    std::vector<TriangleId> all;
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t)
        all.push_back({t});
    const auto parts = border_of(tin, all);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].outer.size(), 4U);
    EXPECT_TRUE(parts[0].holes.empty());
}

}  // namespace
}  // namespace tinsmith::core
