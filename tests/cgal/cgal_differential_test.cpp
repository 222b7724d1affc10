// SPDX-License-Identifier: Apache-2.0
// The same mesh and shape through Tinsmith and through CGAL's recipe b: both must split the same
// edges with the same segments, and those that cross in exact arithmetic. Where rounding decides,
// differences.txt lists each difference, and the test proves which side is right.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "tests/cgal/bundled_data.hpp"
#include "tests/cgal/crossings.hpp"
#include "tests/cgal/delaunay_mesh.hpp"
#include "tests/support/random_input.hpp"

namespace tinsmith::cgal {
namespace {

using core::MeshData;
using core::Point2;
using core::Point3;
using core::Shape;
using test::Random;
using test::uniform;

/// Ours are within 4 ulp of the input. CGAL aims anew from each rounded intersection, and errors
/// add up on a long segment.
constexpr double kOursUlps = 4.0;
constexpr double kPeersUlps = 64.0;

std::vector<Point2> added_by_tinsmith(const core::Tin& before, const Shape& shape) {
    core::Tin tin = before;
    const auto report = core::integrate(tin, {&shape, 1}, {});
    EXPECT_TRUE(report) << report.errors()[0].detail;
    std::vector<Point2> added;
    for (std::uint32_t v = static_cast<std::uint32_t>(before.vertex_count());
         v < tin.vertex_count(); ++v)
        added.push_back(tin.plan({v}));
    return added;
}

std::vector<Point2> added_by_peer(const Peer& before, const core::Tin& tin, const Shape& shape) {
    Peer peer = before;
    peer.insert(drape(tin, shape));
    std::vector<Point2> vertices;
    for (const Point3& v : peer.vertices())
        vertices.push_back(v.plan());
    return vertices;  // those of the mesh stand for nothing
}

struct Comparison {
    Comparison(const core::Tin& tin, const Peer& peer, const MeshData& mesh, const Shape& shape)
        : oracle(mesh, shape),
          ours(oracle.of_vertices(added_by_tinsmith(tin, shape), kOursUlps * oracle.ulp())),
          peers(oracle.of_vertices(added_by_peer(peer, tin, shape), kPeersUlps * oracle.ulp())) {}

    CrossingOracle oracle;
    Crossings ours;
    Crossings peers;
};

void expect_all_agree(const MeshData& mesh, const Shape& shape) {
    const auto tin = core::build_tin(mesh);
    ASSERT_TRUE(tin);
    const Peer peer = Peer::of_triangles(mesh);
    ASSERT_TRUE(peer.is_valid());
    const Comparison all(*tin, peer, mesh, shape);
    EXPECT_GT(all.oracle.exact().edges.size(), 0U);
    EXPECT_EQ(all.ours.edges, all.oracle.exact().edges);
    EXPECT_EQ(all.ours.self, all.oracle.exact().self);
    EXPECT_EQ(all.ours.unexplained.size(), 0U);
    EXPECT_EQ(all.peers.edges, all.oracle.exact().edges);
    EXPECT_EQ(all.peers.self, all.oracle.exact().self);
    EXPECT_EQ(all.peers.unexplained.size(), 0U);
}

/// Shapes that stay within the middle 80 % of a square of that side.
Shape inner_shape(Random& random, test::ShapeKind kind, double side) {
    core::Path path;
    const auto count = static_cast<int>(3 + random() % 30);
    for (int i = 0; i < count; ++i) {
        if (kind == test::ShapeKind::Ring) {
            const double turn = 6.283185307179586 * (i + uniform(random, 0.0, 0.8)) / count;
            const double radius = side * uniform(random, 0.15, 0.4);
            path.points.push_back(
                {side / 2 + radius * std::cos(turn), side / 2 + radius * std::sin(turn)});
        } else {
            const double x = uniform(random, 0.1 * side, 0.9 * side);
            path.points.push_back({x, uniform(random, 0.1 * side, 0.9 * side)});
        }
    }
    path.closed = kind != test::ShapeKind::Line;
    return {{path}};
}

class Generic : public testing::TestWithParam<test::ShapeKind> {};

TEST_P(Generic, RandomDelaunayMeshes) {
    for (std::uint64_t seed = 0; seed < 25; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        std::vector<Point3> points;
        for (int i = 0; i < 400; ++i) {
            const double x = uniform(random, 0.0, 1000.0), y = uniform(random, 0.0, 1000.0);
            points.push_back({x, y, uniform(random, 0.0, 100.0)});
        }
        expect_all_agree(delaunay_mesh(points), inner_shape(random, GetParam(), 1000.0));
    }
}

TEST_P(Generic, JitteredGrids) {
    for (std::uint64_t seed = 0; seed < 25; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const MeshData mesh = test::random_mesh(random, test::MeshKind::Jittered, 16);
        expect_all_agree(mesh, inner_shape(random, GetParam(), 16.0));
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Generic,
                         testing::Values(test::ShapeKind::Ring, test::ShapeKind::Line,
                                         test::ShapeKind::Tangled),
                         [](const auto& kind) {
                             return std::string(kind.param == test::ShapeKind::Ring   ? "Ring"
                                                : kind.param == test::ShapeKind::Line ? "Line"
                                                                                      : "Tangled");
                         });

/// The peer that the benchmarks time keeps the surface, as recipe b claims.
TEST(RecipeB, LeavesTheSurfaceAsItWas) {
    const MeshData mesh = bundled_terrain();
    const auto tin = core::build_tin(mesh);
    ASSERT_TRUE(tin);
    Peer peer = Peer::of_triangles(mesh);
    EXPECT_EQ(peer.vertex_count(), mesh.vertices.size());
    EXPECT_TRUE(peer.is_valid());
    peer.insert(drape(*tin, bundled_shape("contour_3500")));
    EXPECT_TRUE(peer.is_valid());
    const std::vector<Point3> vertices = peer.vertices();
    core::Path all;
    for (const Point3& v : vertices)
        all.points.push_back(v.plan());
    const Polyline on_mesh = drape(*tin, {{all}}).at(0);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        ASSERT_NEAR(vertices[i].z, on_mesh[i].z, 1e-8);
}

/// Turned by the angle whose cosine is 3/5: what was on a grid line is so to within rounding.
Point2 turned(Point2 p) {
    return {0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y};
}

MeshData turned(MeshData mesh) {
    for (Point3& v : mesh.vertices) {
        const Point2 p = turned(v.plan());
        v = {p.x, p.y, v.z};
    }
    return mesh;
}

Shape turned(Shape shape) {
    for (core::Path& path : shape.paths)
        for (Point2& p : path.points)
            p = turned(p);
    return shape;
}

constexpr const char* kMeetings[] = {"apart", "touch", "cross"};

/// "polygon segment edge who exactly excuse" for what one side has and the other has not. Says
/// which of ours exact arithmetic does not bear out.
std::vector<std::string> differences(const std::string& name, const Comparison& all) {
    std::vector<Crossing> unequal;
    std::ranges::set_symmetric_difference(all.ours.edges, all.peers.edges,
                                          std::back_inserter(unequal));
    std::vector<std::string> lines;
    for (const Crossing& c : unequal) {
        const Meeting exactly = meeting(all.oracle.segment(c.segment), all.oracle.edge(c.other));
        const bool is_ours = all.ours.edges.contains(c);
        const std::string excuse = all.oracle.excuse(c);
        std::ostringstream line;
        line << name << " " << c.segment << " " << all.oracle.edge_name(c.other) << " "
             << (is_ours ? "tinsmith" : "cgal") << " " << kMeetings[static_cast<int>(exactly)]
             << " " << excuse;
        lines.push_back(line.str());
        const bool ours_is_right = is_ours == (exactly == Meeting::Cross);
        EXPECT_TRUE(ours_is_right || excuse != "none") << line.str();
    }
    if (!all.peers.unexplained.empty())
        lines.push_back(name + " - - cgal " + std::to_string(all.peers.unexplained.size()) +
                        " vertices off every segment");
    return lines;
}

/// The lines of differences.txt that begin with the name.
std::vector<std::string> listed(const std::string& name) {
    std::ifstream in(std::string(TINSMITH_SOURCE_DIR) + "/tests/cgal/differences.txt");
    EXPECT_TRUE(in);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(name + " ")) lines.push_back(line);
    return lines;
}

class Bundled : public testing::TestWithParam<const char*> {};

void compare_with_list(const std::string& name, const MeshData& mesh, const Shape& shape) {
    const auto tin = core::build_tin(mesh);
    ASSERT_TRUE(tin);
    const Comparison all(*tin, Peer::of_triangles(mesh), mesh, shape);
    EXPECT_EQ(all.ours.unexplained.size(), 0U);
    for (const Crossing& c : all.oracle.exact().edges) {
        if (all.ours.edges.contains(c)) continue;
        EXPECT_NE(all.oracle.excuse(c), "none")
            << "segment " << c.segment << " edge " << all.oracle.edge_name(c.other);
    }
    std::vector<std::string> actual = differences(name, all), expected = listed(name);
    std::ranges::sort(actual);
    std::ranges::sort(expected);
    std::vector<std::string> more, fewer;
    std::ranges::set_difference(actual, expected, std::back_inserter(more));
    std::ranges::set_difference(expected, actual, std::back_inserter(fewer));
    for (const std::string& line : more)
        ADD_FAILURE() << "not listed: " << line;
    for (const std::string& line : fewer)
        ADD_FAILURE() << "listed, but not so: " << line;
}

TEST_P(Bundled, DifferencesAreThoseListed) {
    compare_with_list(GetParam(), bundled_terrain(), bundled_shape(GetParam()));
}

TEST_P(Bundled, DifferencesWhenTurnedAreThoseListed) {
    compare_with_list(std::string(GetParam()) + "_turned", turned(bundled_terrain()),
                      turned(bundled_shape(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Polygons, Bundled,
                         testing::Values("parcel", "lake", "road", "contour_450", "contour_3500"),
                         [](const auto& name) { return std::string(name.param); });

}  // namespace
}  // namespace tinsmith::cgal
