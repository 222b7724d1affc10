// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/walk.hpp"

#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "core/predicates/orientation.hpp"
#include "tests/support/border_shapes.hpp"
#include "tests/support/quad.hpp"
#include "tests/support/random_input.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

using test::area;
using test::sign;

using Kind = Location::Kind;

/// Every triangle looked at, with arithmetic of the test's own.
Location brute_locate(const Tin& tin, Point2 p) {
    Location found;
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
        if (tin.plan({v}) == p) return {Kind::OnVertex, {}, {v}};
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        int zeros = 0, negatives = 0;
        Side edge;
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            const int turn =
                sign(area(tin.plan(tin.origin(side)), tin.plan(tin.destination(side)), p));
            if (turn < 0) ++negatives;
            if (turn == 0) {
                ++zeros;
                edge = side;
            }
        }
        if (negatives > 0) continue;
        if (zeros == 0) return {Kind::InTriangle, {{t}, 0}, {}};
        if (found.kind == Kind::Outside || edge < found.side) found = {Kind::OnEdge, edge, {}};
    }
    return found;
}

/// Locates from every triangle and compares. Empty when all agree.
std::string disagreement(const Tin& tin, Point2 p) {
    const Location expected = brute_locate(tin, p);
    for (std::uint32_t seed = 0; seed < tin.triangle_count(); ++seed) {
        const Location found = locate(tin, p, {seed});
        if (found.kind == expected.kind && found.side == expected.side &&
            found.vertex == expected.vertex)
            continue;
        return std::to_string(p.x) + " " + std::to_string(p.y) + " from triangle " +
               std::to_string(seed) + ": kind " + std::to_string(static_cast<int>(found.kind)) +
               " side " + std::to_string(found.side.code) + " vertex " +
               std::to_string(found.vertex.value) + ", expected kind " +
               std::to_string(static_cast<int>(expected.kind)) + " side " +
               std::to_string(expected.side.code) + " vertex " +
               std::to_string(expected.vertex.value);
    }
    return {};
}

TEST(Locate, FindsLatticePositionsFromEverySeed) {
    MeshData far = test::grid(2, 2);
    for (auto& v : far.vertices)
        v.x += 10;  // a second component beside the ring
    MeshData both = test::ring_of_cells();
    const auto base = static_cast<std::uint32_t>(both.vertices.size());
    both.vertices.insert(both.vertices.end(), far.vertices.begin(), far.vertices.end());
    for (const auto& t : far.triangles)
        both.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    for (const MeshData& mesh : {test::grid(3, 3), test::grid(3, 2, test::Diagonals::Alternate),
                                 test::ring_of_cells(), both}) {
        const Tin tin = test::built(mesh);
        for (int i = -2; i <= 52; ++i)
            for (int k = -2; k <= 14; ++k)
                ASSERT_EQ(disagreement(tin, {i * 0.25, k * 0.25}), "");
    }
}

TEST(Locate, FindsPositionsOnRandomMeshesFromEverySeed) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        test::Random random(seed);
        const auto kind = static_cast<test::MeshKind>(seed % test::kMeshKinds);
        const MeshData mesh = test::random_mesh(random, kind, 2 + static_cast<int>(seed % 4));
        if (mesh.triangles.empty()) continue;
        const Tin tin = test::built(mesh);
        const Bounds& box = tin.bounds();
        for (int i = 0; i < 60; ++i) {
            const double x = test::uniform(random, box.min.x, box.max.x);
            ASSERT_EQ(disagreement(tin, {x, test::uniform(random, box.min.y, box.max.y)}), "")
                << "seed " << seed;
        }
        for (std::uint32_t v = 0; v < tin.vertex_count(); ++v) {
            const Point2 p = tin.plan({v});
            const Point2 q = tin.plan({static_cast<std::uint32_t>(random() % tin.vertex_count())});
            ASSERT_EQ(disagreement(tin, p), "") << "seed " << seed;
            ASSERT_EQ(disagreement(tin, {(p.x + q.x) / 2, (p.y + q.y) / 2}), "") << "seed " << seed;
            ASSERT_EQ(disagreement(tin, {q.x, p.y}), "") << "seed " << seed;
        }
    }
}

TEST(Locate, FindsPositionsByTheHint) {
    const Tin tin = test::built(test::grid(20, 20));
    for (int i = -3; i < 83; ++i) {
        const Point2 p{i * 0.25, (i * 37 % 80) * 0.25};
        const Location found = locate(tin, p, tin.hint(p));
        const Location expected = brute_locate(tin, p);
        EXPECT_EQ(found.kind, expected.kind);
        EXPECT_EQ(found.side, expected.side);
        EXPECT_EQ(found.vertex, expected.vertex);
    }
}

/// What the ray from v towards the target meets in v's star, with arithmetic of the test's own:
/// the far vertex of an edge, or the edge across as a pair, or nothing.
std::pair<std::uint32_t, std::uint32_t> brute_leave(const Tin& tin, VertexId v, Point2 target) {
    const Point2 from = tin.plan(v);
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            if (tin.origin(side) != v) continue;
            const VertexId a = tin.destination(side), b = tin.apex(side);
            for (const VertexId w : {a, b}) {
                const Point2 q = tin.plan(w);
                const double ahead =
                    (q.x - from.x) * (target.x - from.x) + (q.y - from.y) * (target.y - from.y);
                if (sign(area(from, target, q)) == 0 && ahead > 0) return {w.value, UINT32_MAX};
            }
            if (sign(area(from, target, tin.plan(a))) < 0 &&
                sign(area(from, target, tin.plan(b))) > 0)
                return {a.value, b.value};
        }
    }
    return {UINT32_MAX, UINT32_MAX};
}

TEST(Leave, FindsWhereEveryRayLeavesEveryStarFromEveryStart) {
    for (const MeshData& mesh :
         {test::grid(3, 3, test::Diagonals::Alternate), test::ring_of_cells()}) {
        const Tin tin = test::built(mesh);
        for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
            for (unsigned i = 0; i < 3; ++i) {
                const Side start({t}, i);
                const VertexId v = tin.origin(start);
                for (int k = 0; k < 169; ++k) {
                    const Point2 target{k % 13 * 0.5 - 1.5, k / 13 * 0.5 - 1.5};
                    if (target == tin.plan(v)) continue;
                    const auto expected = brute_leave(tin, v, target);
                    const Departure found = leave(tin, v, target, start);
                    switch (found.kind) {
                        case Departure::Kind::AlongEdge:
                            ASSERT_EQ(found.along(tin, v).value, expected.first);
                            ASSERT_EQ(expected.second, UINT32_MAX);
                            break;
                        case Departure::Kind::ThroughEdge:
                            ASSERT_EQ(tin.origin(found.side).value, expected.first);
                            ASSERT_EQ(tin.destination(found.side).value, expected.second);
                            break;
                        case Departure::Kind::Outside:
                            ASSERT_EQ(expected.first, UINT32_MAX);
                            break;
                    }
                }
            }
        }
    }
}

TEST(FindEdge, FindsEveryEdgeAndNoOther) {
    const Tin tin = test::built(test::ring_of_cells(test::Diagonals::Alternate));
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> edges;
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t)
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            edges[std::minmax(tin.origin(side).value, tin.destination(side).value)] = true;
        }
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v) {
        for (std::uint32_t w = 0; w < tin.vertex_count(); ++w) {
            if (v == w) continue;
            const Side side = find_edge(tin, {v}, {w});
            ASSERT_EQ(side.valid(), edges.contains(std::minmax(v, w))) << v << " " << w;
            if (!side.valid()) continue;
            ASSERT_EQ(std::minmax(tin.origin(side).value, tin.destination(side).value),
                      std::minmax(v, w));
        }
    }
}

TEST(FindEdge, FindsEveryEdgeOfAHubFromEitherEnd) {
    for (const bool closed : {true, false}) {
        constexpr std::uint32_t kRim = 200;
        MeshData mesh{{{0, 0, 0}}, {}, {}};
        for (std::uint32_t i = 0; i < kRim; ++i)
            mesh.vertices.push_back({std::cos(i * 0.03), std::sin(i * 0.03), 0});
        for (std::uint32_t i = 1; i < kRim; ++i)
            mesh.triangles.push_back({0, i, i + 1});
        if (closed) mesh.triangles.push_back({0, kRim, 1});
        const Tin tin = test::built(mesh);
        for (std::uint32_t v = 1; v <= kRim; ++v) {
            for (const auto& [from, to] : {std::pair{0U, v}, std::pair{v, 0U}}) {
                const Side side = find_edge(tin, {from}, {to});
                ASSERT_TRUE(side.valid());
                ASSERT_EQ(std::minmax(tin.origin(side).value, tin.destination(side).value),
                          std::minmax(from, to));
            }
            ASSERT_EQ(find_edge(tin, {v}, {v % kRim + 1}).valid(), closed || v < kRim);
            ASSERT_FALSE(find_edge(tin, {v}, {(v + 1) % kRim + 1}).valid());
        }
    }
}

TEST(Locate, FindsEveryPlaceAmongHolesAndTouchingComponents) {
    for (const test::BorderShape& shape : test::border_shapes()) {
        const Tin tin = test::built(shape.make(30).mesh);
        const Bounds& box = tin.bounds();
        for (int i = 0; i < 400; ++i) {
            const Point2 p{box.min.x + (box.max.x - box.min.x) * (i % 20 + 0.5) / 19.0,
                           box.min.y + (box.max.y - box.min.y) * (i / 20 - 0.5) / 18.0};
            const Location expected = brute_locate(tin, p);
            const Location found = locate(tin, p, tin.hint(p));
            ASSERT_EQ(found.kind, expected.kind) << shape.name << " " << p.x << " " << p.y;
            ASSERT_EQ(found.side, expected.side) << shape.name << " " << p.x << " " << p.y;
            ASSERT_EQ(found.vertex, expected.vertex) << shape.name << " " << p.x << " " << p.y;
        }
    }
}

TEST(BoundarySide, StartsAtEveryBoundaryVertexAndAtNoOther) {
    const Tin tin = test::built(test::grid(3, 3));
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v) {
        const Point2 p = tin.plan({v});
        const bool rim = p.x == 0 || p.y == 0 || p.x == 3 || p.y == 3;
        const Side side = boundary_side_from(tin, {v});
        ASSERT_EQ(side.valid(), rim);
        if (!rim) continue;
        EXPECT_EQ(tin.origin(side), VertexId{v});
        EXPECT_FALSE(tin.twin(side).valid());
    }
}

}  // namespace
}  // namespace tinsmith::core
