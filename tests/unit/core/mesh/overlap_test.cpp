// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/mesh/build.hpp"
#include "core/predicates/orientation.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

std::vector<ErrorCode> codes(const MeshData& mesh) {
    std::vector<ErrorCode> found;
    const auto tin = build_tin(mesh);
    if (!tin)
        for (const Error& error : tin.errors())
            found.push_back(error.code);
    return found;
}

/// Adds a triangle with vertices of its own.
void add(MeshData& mesh, Point3 a, Point3 b, Point3 c) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
}

MeshData soup(const std::vector<std::array<Point3, 3>>& triangles) {
    MeshData mesh;
    for (const auto& [a, b, c] : triangles)
        add(mesh, a, b, c);
    return mesh;
}

TEST(Overlap, TakesPartsThatOnlyTouch) {
    EXPECT_EQ(codes(soup({{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},     // a side in common
                          {{{4, 0, 0}, {4, 4, 0}, {0, 4, 0}}},     //
                          {{{2, -2, 0}, {3, -2, 0}, {2, 0, 0}}},   // a corner in a side
                          {{{-3, 1, 0}, {0, 1, 0}, {0, 2, 0}}},    // part of a side
                          {{{-3, -3, 0}, {0, -3, 0}, {0, 0, 0}}},  // a corner in common
                          {{{4, 4, 0}, {9, 4, 0}, {9, 9, 0}}}})),
              std::vector<ErrorCode>{});
}

TEST(Overlap, RefusesAPartAboveAnother) {
    MeshData mesh = test::grid(6, 6);
    add(mesh, {2.2, 2.2, 9}, {2.4, 2.2, 9}, {2.2, 2.4, 9});  // shares no vertex, crosses no edge
    const auto tin = build_tin(mesh);
    ASSERT_FALSE(tin);
    ASSERT_EQ(tin.errors().size(), 1U);
    const Error& error = tin.errors()[0];
    EXPECT_EQ(error.code, ErrorCode::MeshOverlaps);
    EXPECT_EQ(error.place.triangle, mesh.triangles.size() - 1);
    EXPECT_EQ(error.place.position, (Point2{2.2, 2.2}));
}

TEST(Overlap, RefusesAPartBelowAWholeMesh) {
    MeshData mesh = soup({{{{-20, -20, 0}, {90, -20, 0}, {-20, 90, 0}}}});
    const MeshData small = test::grid(3, 3);
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), small.vertices.begin(), small.vertices.end());
    for (const auto& [a, b, c] : small.triangles)
        mesh.triangles.push_back({a + base, b + base, c + base});
    EXPECT_EQ(codes(mesh), std::vector{ErrorCode::MeshOverlaps});
}

TEST(Overlap, RefusesSidesThatCross) {
    EXPECT_EQ(
        codes(soup({{{{0, 0, 0}, {9, 0, 0}, {0, 1, 0}}}, {{{4, -3, 0}, {5, -3, 0}, {4, 3, 0}}}})),
        std::vector{ErrorCode::MeshOverlaps});
    // All sides through one point.
    EXPECT_EQ(
        codes(soup({{{{-2, 0, 0}, {2, 0, 0}, {0, 3, 0}}}, {{{0, -2, 0}, {1, -2, 0}, {0, 2, 0}}}})),
        std::vector{ErrorCode::MeshOverlaps});
}

TEST(Overlap, RefusesTheSameTriangleTwice) {
    EXPECT_EQ(
        codes(soup({{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}})),
        std::vector{ErrorCode::MeshOverlaps});
}

/// A ramp that goes round more than once, as in a car park, without a vertex in its middle.
TEST(Overlap, RefusesARampThatGoesRoundTwice) {
    MeshData mesh;
    constexpr std::uint32_t kSteps = 24;
    for (std::uint32_t i = 0; i <= kSteps; ++i) {
        const double turn = i * 0.31, z = i;
        mesh.vertices.push_back({5 * std::cos(turn), 5 * std::sin(turn), z});
        mesh.vertices.push_back({9 * std::cos(turn), 9 * std::sin(turn), z});
    }
    const auto ramp = [&](std::uint32_t steps) {
        MeshData out{{mesh.vertices.begin(), mesh.vertices.begin() + 2 * steps + 2}, {}, {}};
        for (std::uint32_t i = 0; i < steps; ++i) {
            const std::uint32_t a = 2 * i;
            out.triangles.push_back({a, a + 1, a + 3});
            out.triangles.push_back({a, a + 3, a + 2});
        }
        return out;
    };
    EXPECT_EQ(codes(ramp(20)), std::vector<ErrorCode>{});  // 6.2 of 6.28
    EXPECT_EQ(codes(ramp(kSteps)), std::vector{ErrorCode::MeshOverlaps});
}

TEST(Overlap, RefusesTwoElevationsAtOnePlace) {
    const auto cliff =
        soup({{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{4, 0, 1}, {4, 4, 1}, {0, 4, 0}}}});
    const auto tin = build_tin(cliff);
    ASSERT_FALSE(tin);
    ASSERT_EQ(tin.errors().size(), 1U);
    EXPECT_EQ(tin.errors()[0].code, ErrorCode::ElevationTwice);
    EXPECT_EQ(tin.errors()[0].place.vertex, 3U);
}

TEST(Overlap, TellsFaultsByTheNamesGiven) {
    auto mesh = soup({{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}});
    const std::vector<std::uint32_t> triangles{70, 71};
    const auto tin = build_tin(mesh, {{}, triangles});
    ASSERT_FALSE(tin);
    EXPECT_GE(tin.errors()[0].place.triangle, 70U);
}

/// Whether two triangles have a point inside both: by all nine pairs of sides and six corners.
bool have_inside_in_common(const std::array<Point2, 3>& s, const std::array<Point2, 3>& t) {
    // Of two convex figures that do not, one has a side with the other on its far side.
    const auto is_parted = [](const auto& a, const auto& b) {
        for (std::size_t i = 0; i < 3; ++i) {
            const bool all = std::all_of(b.begin(), b.end(), [&](Point2 p) {
                return orientation(a[i], a[(i + 1) % 3], p) != Orientation::CounterClockwise;
            });
            if (all) return true;
        }
        return false;
    };
    return !is_parted(s, t) && !is_parted(t, s);
}

/// Small soups on a small lattice, where everything touches everything, against all pairs.
TEST(Overlap, AgreesWithAllPairsOfRandomTriangles) {
    std::mt19937 random(7);
    std::size_t overlapping = 0, clean = 0;
    for (int round = 0; round < 20'000; ++round) {
        const int size = 2 + round % 5;
        std::uniform_int_distribution<int> place(0, size), count(2, 5);
        std::vector<std::array<Point2, 3>> triangles;
        MeshData mesh;
        for (int i = count(random); i > 0; --i) {
            std::array<Point2, 3> t;
            do {
                for (Point2& p : t)
                    p = {static_cast<double>(place(random)), static_cast<double>(place(random))};
            } while (!is_left(t[0], t[1], t[2]));
            triangles.push_back(t);
            add(mesh, {t[0].x, t[0].y, 0}, {t[1].x, t[1].y, 0}, {t[2].x, t[2].y, 0});
        }
        bool expected = false;
        for (std::size_t i = 0; i < triangles.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                expected = expected || have_inside_in_common(triangles[i], triangles[j]);
        EXPECT_EQ(!codes(mesh).empty(), expected) << "round " << round;
        ++(expected ? overlapping : clean);
    }
    EXPECT_GT(overlapping, 1000U);
    EXPECT_GT(clean, 1000U);
}

}  // namespace
}  // namespace tinsmith::core
