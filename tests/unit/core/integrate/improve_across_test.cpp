// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/improve_across.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "core/integrate/swap_criterion.hpp"
#include "core/mesh/walk.hpp"
#include "tests/support/quad.hpp"
#include "tests/support/random_input.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

using test::built;
using test::Quad;

const double kNoLimit = std::numeric_limits<double>::infinity();

std::vector<VertexId> all_vertices(const Tin& tin) {
    std::vector<VertexId> all;
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
        all.push_back({v});
    return all;
}

/// The edge 0-1 with vertex 2 on its left and 3 on its right.
MeshData quad(Point3 a, Point3 b, Point3 c, Point3 d) {
    return {{a, b, c, d}, {{0, 1, 2}, {1, 0, 3}}, {}};
}

/// The long diagonal of a rhombus, level; the others `height` above.
MeshData saddle(double height) {
    return quad({-2, 0, 0}, {2, 0, 0}, {0, 1, height}, {0, -1, height});
}

/// What improving around all vertices did to a mesh.
struct Result {
    CrossFacetImprover::Outcome outcome;
    bool has_edge_01 = false;
    std::vector<std::string> broken;
};

Result improve(Tin& tin, double limit = kNoLimit) {
    Result result;
    CrossFacetImprover improver(limit);
    Surgery surgery(tin);
    result.outcome = improver.improve(surgery, all_vertices(tin));
    surgery.commit();
    EXPECT_EQ(result.outcome.max_deviation, improver.max_deviation());
    EXPECT_EQ(result.outcome.edges_swapped, improver.edges_swapped());
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t)
        for (unsigned i = 0; i < 3; ++i) {
            const Side s({t}, i);
            if (tin.origin(s).value == 0 && tin.destination(s).value == 1)
                result.has_edge_01 = true;
        }
    result.broken = test::check_valid(tin);
    return result;
}

Result improve(const MeshData& mesh, double limit = kNoLimit) {
    Tin tin = built(mesh);
    return improve(tin, limit);
}

TEST(ImproveAcross, SwapsTheLongDiagonalOfALevelQuadAndMovesNothing) {
    const Result result = improve(saddle(0.0));
    EXPECT_FALSE(result.has_edge_01);
    EXPECT_EQ(result.outcome.edges_swapped, 1u);
    EXPECT_EQ(result.outcome.max_deviation, 0.0);
    EXPECT_TRUE(result.broken.empty());
}

TEST(ImproveAcross, CertifiesWhatASaddleMoves) {
    const Result result = improve(saddle(0.25));
    EXPECT_FALSE(result.has_edge_01);
    EXPECT_GE(result.outcome.max_deviation, 0.25);
    EXPECT_LE(result.outcome.max_deviation, 0.25 * (1 + 1e-9));
}

TEST(ImproveAcross, LeavesTheBetterDiagonal) {
    EXPECT_TRUE(improve(quad({0, -1, 0}, {0, 1, 0}, {-2, 0, 0}, {2, 0, 0})).has_edge_01);
}

TEST(ImproveAcross, LeavesTheDiagonalOfASquare) {
    EXPECT_TRUE(improve(quad({0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0})).has_edge_01);
}

TEST(ImproveAcross, LeavesAQuadThatIsNotConvex) {
    // Both triangles are flat about 0-1; the other diagonal would run outside.
    EXPECT_TRUE(improve(quad({0, 0, 0}, {9, 0, 0}, {-1, 1, 0}, {-1, -1, 0})).has_edge_01);
    EXPECT_TRUE(improve(quad({0, 0, 0}, {9, 0, 0}, {0, 1, 0}, {0, -1, 0})).has_edge_01);
}

TEST(ImproveAcross, LeavesAnEdgeWhoseSwapWouldMakeASharperOne) {
    // 45.0 degrees become 52.3, and nothing else speaks against it.
    const SwapQuad corners{{-5, 0, 0}, {5, 0, 0}, {4, 2, 0}, {4, -3, 3}};
    EXPECT_TRUE(improves_aspect(corners) && can_swap(corners));
    EXPECT_TRUE(improve(quad(corners.a, corners.b, corners.c, corners.d)).has_edge_01);
}

TEST(ImproveAcross, LeavesConstrainedEdges) {
    MeshData mesh = saddle(0.0);
    mesh.constraints.push_back({0, 1});
    EXPECT_TRUE(improve(mesh).has_edge_01);
}

TEST(ImproveAcross, LeavesLockedEdges) {
    Tin tin = built(saddle(0.0));
    Surgery surgery(tin);
    surgery.set_locked(find_edge(tin, {0}, {1}), true);
    surgery.commit();
    EXPECT_TRUE(improve(tin).has_edge_01);
}

TEST(ImproveAcross, LeavesBoundaryEdges) {
    const Result result = improve(test::one_triangle());
    EXPECT_TRUE(result.has_edge_01);
    EXPECT_EQ(result.outcome.edges_swapped, 0u);
}

TEST(ImproveAcross, RefusesExactlyWhatPassesTheLimit) {
    const double needed = improve(saddle(0.25)).outcome.max_deviation;
    EXPECT_FALSE(improve(saddle(0.25), needed).has_edge_01);
    EXPECT_TRUE(improve(saddle(0.25), std::nextafter(needed, 0.0)).has_edge_01);
    EXPECT_TRUE(improve(saddle(0.25), 0.0).has_edge_01);
    EXPECT_FALSE(improve(saddle(0.0), 0.0).has_edge_01);
}

TEST(ImproveAcross, TheTrianglesItMakesAreNewFacetsOfTheirOwn) {
    Tin tin = built(saddle(0.25));
    ASSERT_EQ(improve(tin).outcome.edges_swapped, 1u);
    EXPECT_NE(tin.facet({0}), tin.facet({1}));
    EXPECT_GE(std::min(tin.facet({0}), tin.facet({1})).value, 2u);
}

TEST(ImproveAcross, AddsToWhatTheTrianglesCarryAlready) {
    // Swapping 0-1 makes the triangle 3-1-2; then 1-2, with the sliver 1-4-2 beyond, is the next.
    MeshData mesh = saddle(0.25);
    mesh.vertices.push_back({1.05, 0.6, 0.17});
    mesh.triangles.push_back({1, 4, 2});
    const auto& v = mesh.vertices;
    const double second = vertical_gap({v[1], v[2], v[3], v[4]});
    ASSERT_GT(second, 0.01);
    Tin tin = built(mesh);
    CrossFacetImprover improver;
    Surgery surgery(tin);
    const auto outcome = improver.improve(surgery, std::vector<VertexId>{VertexId{3}});
    EXPECT_EQ(outcome.edges_swapped, 2u);
    EXPECT_NEAR(outcome.max_deviation, 0.25 + second, 1e-9);
    EXPECT_GE(outcome.max_deviation, 0.25 + second);
    // Where what was carried is too much already, the second swap is refused.
    surgery.roll_back();
    CrossFacetImprover bounded(0.25 + second / 2);
    Surgery again(tin);
    EXPECT_EQ(bounded.improve(again, std::vector<VertexId>{VertexId{3}}).edges_swapped, 1u);
}

TEST(ImproveAcross, WhatEitherTriangleCarriesCounts) {
    MeshData mesh = saddle(0.25);
    mesh.vertices.push_back({1.05, 0.6, 0.17});
    mesh.triangles.push_back({1, 4, 2});
    Tin tin = built(mesh);
    CrossFacetImprover improver;
    Surgery surgery(tin);
    surgery.set_locked(find_edge(tin, {1}, {2}), true);
    ASSERT_EQ(improver.improve(surgery, std::vector<VertexId>{VertexId{3}}).edges_swapped, 1u);
    surgery.set_locked(find_edge(tin, {1}, {2}), false);
    // From vertex 4 the edge is seen from the sliver, which carries nothing.
    const auto outcome = improver.improve(surgery, std::vector<VertexId>{VertexId{4}});
    EXPECT_EQ(outcome.edges_swapped, 1u);
    EXPECT_GT(outcome.max_deviation, 0.25);
}

TEST(ImproveAcross, InsideAFacetNothingIsCarriedAndTheFacetStays) {
    const MeshData mesh{{{0, 0, 0}, {100, 0, 30}, {0, 100, 70}}, {{0, 1, 2}}, {}};
    Tin tin = built(mesh);
    std::mt19937_64 random(1);
    Shape shape;
    for (int i = 0; i < 100; ++i)
        shape.paths.push_back(
            {{{test::uniform(random, 1, 49), test::uniform(random, 1, 49)}}, false});
    IntegrateOptions options;
    options.improve = Improve::None;
    ASSERT_TRUE(integrate(tin, std::vector{shape}, options));
    const Result result = improve(tin, 0.0);
    EXPECT_GT(result.outcome.edges_swapped, 50u);
    EXPECT_EQ(result.outcome.max_deviation, 0.0);
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t)
        ASSERT_EQ(tin.facet({t}), tin.facet({0}));
}

/// Largest vertical distance of two surfaces with the same vertices: where edges of the two cross,
/// for between those places the distance is linear. By comparing all edges with all.
double deviation(const MeshData& one, const MeshData& other) {
    const auto edges = [](const MeshData& mesh) {
        std::set<std::pair<std::uint32_t, std::uint32_t>> found;
        for (const auto& t : mesh.triangles)
            for (unsigned i = 0; i < 3; ++i)
                found.insert(std::minmax(t[i], t[(i + 1) % 3]));
        return found;
    };
    const auto& v = one.vertices;
    const auto others = edges(other);
    const auto apart = [](double a, double b, double c, double d) {
        return std::max(a, b) < std::min(c, d) || std::max(c, d) < std::min(a, b);
    };
    Quad worst = 0;
    for (const auto& [a, b] : edges(one)) {
        for (const auto& [c, d] : others) {
            if (apart(v[a].x, v[b].x, v[c].x, v[d].x) || apart(v[a].y, v[b].y, v[c].y, v[d].y))
                continue;
            const Quad to_a = test::area(v[c].plan(), v[d].plan(), v[a].plan());
            const Quad to_b = test::area(v[c].plan(), v[d].plan(), v[b].plan());
            const Quad to_c = test::area(v[a].plan(), v[b].plan(), v[c].plan());
            const Quad to_d = test::area(v[a].plan(), v[b].plan(), v[d].plan());
            if (test::sign(to_a) * test::sign(to_b) >= 0 ||
                test::sign(to_c) * test::sign(to_d) >= 0)
                continue;
            const Quad first = (Quad(v[a].z) * to_b - Quad(v[b].z) * to_a) / (to_b - to_a);
            const Quad second = (Quad(v[c].z) * to_d - Quad(v[d].z) * to_c) / (to_d - to_c);
            worst = std::max(worst, first < second ? second - first : first - second);
        }
    }
    return static_cast<double>(worst);
}

/// A rough mesh, some of its edges constrained.
MeshData rough(std::mt19937_64& random, int trial) {
    MeshData mesh = test::random_mesh(
        random, trial % 3 == 0 ? test::MeshKind::Concave : test::MeshKind::Jittered, 9);
    for (Point3& v : mesh.vertices)
        v.z = test::uniform(random, 0.0, trial % 2 == 0 ? 0.1 : 2.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 7)
        mesh.constraints.push_back({mesh.triangles[t][0], mesh.triangles[t][1]});
    return mesh;
}

TEST(ImproveAcross, CanBeTakenBack) {
    std::mt19937_64 random(4);
    Tin tin = built(rough(random, 1));
    const Tin before = tin;
    CrossFacetImprover improver;
    Surgery surgery(tin);
    ASSERT_GT(improver.improve(surgery, all_vertices(tin)).edges_swapped, 10u);
    EXPECT_FALSE(test::same_slots(tin, before));
    surgery.roll_back();
    EXPECT_TRUE(test::same_slots(tin, before));
}

TEST(ImproveAcross, TheSurfaceIsNeverFartherThanCertifiedNorThanTheLimit) {
    std::mt19937_64 random(2);
    std::uint64_t free = 0, held = 0;
    for (int trial = 0; trial < 40; ++trial) {
        const MeshData mesh = rough(random, trial);
        for (const double limit : {kNoLimit, 0.05}) {
            Tin tin = built(mesh);
            CrossFacetImprover improver(limit);
            double certified = 0.0;
            // In parts, as for the shapes of a request.
            const std::vector<VertexId> all = all_vertices(tin);
            for (std::size_t first = 0; first < all.size(); first += 25) {
                Surgery surgery(tin);
                const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
                const auto end = begin + std::min<std::ptrdiff_t>(25, all.end() - begin);
                certified =
                    std::max(certified, improver.improve(surgery, {begin, end}).max_deviation);
                surgery.commit();
                ASSERT_LE(deviation(built(mesh).to_data(), tin.to_data()), certified) << trial;
            }
            EXPECT_EQ(certified, improver.max_deviation());
            EXPECT_LE(certified, limit);
            EXPECT_TRUE(test::check_valid(tin).empty());
            EXPECT_EQ(tin.to_data().constraints, built(mesh).to_data().constraints);
            (limit < kNoLimit ? held : free) += improver.edges_swapped();
        }
    }
    EXPECT_GT(free, 1000u);
    EXPECT_GT(held, 200u);
    EXPECT_GT(free, held);
}

TEST(ImproveAcross, EndsWhereNoEdgeIsLeftToSwapAndTheSameEachTime) {
    std::mt19937_64 random(3);
    for (int trial = 0; trial < 20; ++trial) {
        const MeshData mesh = rough(random, trial);
        Tin tin = built(mesh), again = built(mesh);
        const double limit = trial % 2 == 0 ? kNoLimit : 0.1;
        CrossFacetImprover improver(limit), other(limit);
        Surgery surgery(tin), surgery_again(again);
        EXPECT_GT(improver.improve(surgery, all_vertices(tin)).edges_swapped, 0u);
        EXPECT_EQ(improver.improve(surgery, all_vertices(tin)).edges_swapped, 0u);
        other.improve(surgery_again, all_vertices(again));
        surgery.commit();
        surgery_again.commit();
        EXPECT_TRUE(test::same_slots(tin, again));
        EXPECT_EQ(improver.max_deviation(), other.max_deviation());
    }
}

}  // namespace
}  // namespace tinsmith::core
