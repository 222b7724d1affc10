// SPDX-License-Identifier: Apache-2.0
// What `strict` promises: in each facet that a shape met, the triangles are the constrained
// Delaunay triangulation of the facet's vertices in the facet's own plane. CGAL builds that; ours
// may have no smaller angles.
#include <algorithm>
#include <map>
#include <optional>
#include <sstream>

#include <gtest/gtest.h>

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "tests/cgal/delaunay_mesh.hpp"
#include "tests/cgal/facet_delaunay.hpp"
#include "tests/support/random_input.hpp"

namespace tinsmith::cgal {
namespace {

using core::MeshData;
using core::Point3;
using core::Side;
using core::TriangleId;
using test::Random;
using test::uniform;

constexpr double kSameAngleDegrees = 1e-9;

/// The facets of more than one triangle, by their triangles before the operation.
std::map<std::uint32_t, Facet> facets_met(const core::Tin& before, const core::Tin& after) {
    std::map<std::uint32_t, std::uint32_t> original;  // facet id -> triangle
    for (std::uint32_t t = 0; t < before.triangle_count(); ++t)
        original[before.facet({t}).value] = t;
    std::map<std::uint32_t, std::vector<std::uint32_t>> pieces;
    for (std::uint32_t t = 0; t < after.triangle_count(); ++t)
        pieces[original.at(after.facet({t}).value)].push_back(t);

    std::map<std::uint32_t, Facet> facets;
    for (const auto& [first, triangles] : pieces) {
        if (triangles.size() < 2) continue;
        Facet facet;
        for (std::size_t i = 0; i < 3; ++i)
            facet.plane[i] = before.vertex(before.triangle({first}).vertices[i]).point();
        std::map<core::VertexId, std::uint32_t> slots;
        const auto slot = [&](core::VertexId v) {
            const auto [at, added] =
                slots.emplace(v, static_cast<std::uint32_t>(facet.points.size()));
            if (added) facet.points.push_back(after.plan(v));
            return at->second;
        };
        for (const std::uint32_t t : triangles) {
            Triple corners{};
            for (unsigned i = 0; i < 3; ++i) {
                const Side side(TriangleId{t}, i), twin = after.twin(side);
                corners[i] = slot(after.origin(side));
                const auto edge = std::pair(corners[i], slot(after.destination(side)));
                if (after.separates_facets(side)) {
                    facet.outline.push_back(edge);
                } else if (after.is_constrained(side) && side < twin) {
                    facet.fixed.push_back(edge);
                }
            }
            facet.triangles.push_back(corners);
        }
        facets.emplace(first, std::move(facet));
    }
    return facets;
}

/// What of ours is worse than CGAL's: the first angle from the smallest in which they differ.
std::optional<std::string> worse(const Facet& facet) {
    const std::vector<Triple> peers = constrained_delaunay(facet);
    if (peers.size() != facet.triangles.size())
        return "CGAL has " + std::to_string(peers.size()) + " triangles, ours are " +
               std::to_string(facet.triangles.size());
    const auto ours = smallest_angles(facet, facet.triangles);
    const auto best = smallest_angles(facet, peers);
    for (std::size_t i = 0; i < ours.size(); ++i) {
        if (ours[i] > best[i] + kSameAngleDegrees) return {};
        if (ours[i] < best[i] - kSameAngleDegrees) {
            std::ostringstream text;
            text << "angle " << i << " of " << ours.size() << ": " << ours[i]
                 << " degrees, CGAL has " << best[i];
            return text.str();
        }
    }
    return {};
}

/// Integrates the shapes one after another and compares every facet met. Returns their number.
std::size_t expect_best(const MeshData& mesh, const std::vector<core::Shape>& shapes) {
    const auto before = core::build_tin(mesh);
    EXPECT_TRUE(before);
    core::Tin tin = *before;
    for (const core::Shape& shape : shapes) {
        core::IntegrateOptions options;
        options.improve = core::Improve::Strict;
        const auto report = core::integrate(tin, {&shape, 1}, options);
        EXPECT_TRUE(report || report.errors()[0].code == core::ErrorCode::OutsideMesh)
            << report.errors()[0].detail;
    }
    const auto facets = facets_met(*before, tin);
    for (const auto& [triangle, facet] : facets) {
        const auto fault = worse(facet);
        EXPECT_FALSE(fault) << "facet of triangle " << triangle << ", " << *fault;
    }
    return facets.size();
}

constexpr test::ShapeKind kKinds[] = {test::ShapeKind::Ring, test::ShapeKind::Line,
                                      test::ShapeKind::Tangled, test::ShapeKind::Spike,
                                      test::ShapeKind::Lattice};

TEST(StrictOracle, JitteredGrids) {
    std::size_t facets = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const MeshData mesh = test::random_mesh(random, test::MeshKind::Jittered, 5);
        facets += expect_best(mesh, {test::random_shape(random, kKinds[seed % 5], mesh)});
    }
    EXPECT_GT(facets, 1000U);
}

TEST(StrictOracle, SteepDelaunayMeshes) {
    std::size_t facets = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        std::vector<Point3> points;
        for (int i = 0; i < 60; ++i) {
            const double x = uniform(random, 0.0, 100.0), y = uniform(random, 0.0, 100.0);
            points.push_back({x, y, uniform(random, 0.0, 200.0)});
        }
        const MeshData mesh = delaunay_mesh(points);
        facets += expect_best(mesh, {test::random_shape(random, kKinds[seed % 4], mesh)});
    }
    EXPECT_GT(facets, 1000U);
}

/// On a lattice of needles four points can lie on a circle but for 1e-18 of it, where either
/// diagonal will do but their angles differ: no shapes on the lattice here.
TEST(StrictOracle, MeshesOfEveryOtherKind) {
    for (const auto kind : {test::MeshKind::Grid, test::MeshKind::Concave, test::MeshKind::Holes,
                            test::MeshKind::Needles, test::MeshKind::FarAway}) {
        std::size_t facets = 0;
        for (std::uint64_t seed = 0; seed < 40; ++seed) {
            SCOPED_TRACE(testing::Message()
                         << "kind " << static_cast<int>(kind) << " seed " << seed);
            Random random(seed);
            const MeshData mesh = test::random_mesh(random, kind, 5);
            facets += expect_best(mesh, {test::random_shape(random, kKinds[seed % 4], mesh)});
        }
        EXPECT_GT(facets, 300U);
    }
}

/// Later shapes cut what earlier ones left.
TEST(StrictOracle, SeveralShapesInOneMesh) {
    for (std::uint64_t seed = 0; seed < 25; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const MeshData mesh = test::random_mesh(random, test::MeshKind::Jittered, 4);
        std::vector<core::Shape> shapes;
        for (int i = 0; i < 4; ++i)
            shapes.push_back(test::random_shape(random, kKinds[random() % 4], mesh));
        EXPECT_GT(expect_best(mesh, shapes), 0U);
    }
}

/// A ring of many vertices within one facet, which is steep.
TEST(StrictOracle, ManyVerticesInOneFacet) {
    const MeshData mesh{
        {{0.0, 0.0, 0.0}, {100.0, 3.0, 150.0}, {40.0, 90.0, 20.0}}, {{0, 1, 2}}, {}};
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        core::Path ring;
        ring.closed = true;
        for (int i = 0; i < 40; ++i) {
            const double turn = 6.283185307179586 * (i + uniform(random, 0.0, 0.8)) / 40.0;
            const double radius = uniform(random, 8.0, 20.0);
            ring.points.push_back({47.0 + radius * std::cos(turn), 32.0 + radius * std::sin(turn)});
        }
        EXPECT_EQ(expect_best(mesh, {{{ring}}}), 1U);
    }
}

/// The comparison itself: a triangulation with one bad diagonal is found out.
TEST(StrictOracle, FindsABadDiagonal) {
    Facet facet{{Point3{0.0, 0.0, 0.0}, Point3{1.0, 0.0, 0.0}, Point3{0.0, 1.0, 0.0}},
                {{0.0, 0.0}, {4.0, -1.0}, {8.0, 0.0}, {4.0, 1.0}},
                {{0, 1, 2}, {0, 2, 3}},
                {{0, 1}, {1, 2}, {2, 3}, {3, 0}},
                {}};
    EXPECT_TRUE(worse(facet));
    facet.triangles = {{0, 1, 3}, {1, 2, 3}};
    EXPECT_FALSE(worse(facet));
    // So steep along y that the other diagonal is the better one.
    facet.plane = {Point3{0.0, 0.0, 0.0}, Point3{1.0, 0.0, 0.0}, Point3{0.0, 1.0, 10.0}};
    EXPECT_TRUE(worse(facet));
    facet.triangles = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_FALSE(worse(facet));
    // A fixed edge stays, good or bad.
    facet.plane[2].z = 0.0;
    facet.fixed = {{0, 2}};
    EXPECT_FALSE(worse(facet));
}

}  // namespace
}  // namespace tinsmith::cgal
