// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/improve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/mesh/walk.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::built;
using test::integrate_checked;

struct Vector {
    long double x, y, z;
};

Vector from_to(Point3 a, Point3 b) {
    const long double x = b.x, y = b.y, z = b.z;
    return {x - a.x, y - a.y, z - a.z};
}

long double dot(Vector u, Vector v) {
    return u.x * v.x + u.y * v.y + u.z * v.z;
}

long double length(Vector u) {
    return std::sqrt(dot(u, u));
}

long double angle_at(Point3 v, Point3 a, Point3 b) {
    const Vector u = from_to(v, a), w = from_to(v, b);
    const Vector n{u.y * w.z - u.z * w.y, u.z * w.x - u.x * w.z, u.x * w.y - u.y * w.x};
    return std::atan2(length(n), dot(u, w));
}

bool is_convex(Point2 a, Point2 d, Point2 b, Point2 c) {
    const auto left = [](Point2 p, Point2 q, Point2 r) {
        return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x) > 0;
    };
    return left(a, d, c) && left(d, b, c);
}

struct Findings {
    int edges = 0;  ///< edges inside facets that may be swapped
    int worse = 0;  ///< those across from which the angles sum to more than 180 degrees
};

/// Delaunay's local condition, in space, on every edge that may be swapped: with constraints, it
/// holds on all of them exactly for the constrained Delaunay triangulation. Edges of which neither
/// end is `first_vertex` or a later one are passed over.
Findings look_at(const Tin& tin, std::uint32_t first_vertex = 0) {
    Findings found;
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            if (tin.is_fixed(side) || tin.separates_facets(side)) continue;
            const Side across = tin.twin(side);
            if (across < side) continue;
            if (std::max(tin.origin(side).value, tin.destination(side).value) < first_vertex)
                continue;
            ++found.edges;
            const Point3 a = tin.vertex(tin.origin(side)).point();
            const Point3 b = tin.vertex(tin.destination(side)).point();
            const Point3 c = tin.vertex(tin.apex(side)).point();
            const Point3 d = tin.vertex(tin.apex(across)).point();
            const long double sum = angle_at(c, a, b) + angle_at(d, a, b);
            if (sum > 3.14159265358979323846L + 1e-9L &&
                is_convex(a.plan(), d.plan(), b.plan(), c.plan()))
                ++found.worse;
        }
    }
    return found;
}

/// A triangle on a plane that rises `slope` for one to the north-east.
MeshData sloping(double slope) {
    return {{{0, 0, 0}, {100, 0, 70 * slope}, {0, 100, 70 * slope}}, {{0, 1, 2}}, {}};
}

Shape random_points(std::mt19937_64& random, int count) {
    std::uniform_real_distribution<double> number(1.0, 49.0);
    Shape shape;
    for (int i = 0; i < count; ++i) {
        const double x = number(random);
        shape.paths.push_back({{{x, number(random)}}, false});
    }
    return shape;
}

TEST(Improve, GivesTheDelaunayTriangulationOfAFacetInItsPlane) {
    for (const double slope : {0.0, 0.3, 1.0, 5.0}) {
        std::mt19937_64 random(1);
        Tin tin = built(sloping(slope));
        const auto outcome = integrate_checked(tin, {random_points(random, 400)});
        ASSERT_EQ(outcome.broken, "") << "slope " << slope;
        const Findings found = look_at(tin);
        EXPECT_GT(found.edges, 1000);
        EXPECT_EQ(found.worse, 0) << "slope " << slope;
    }
}

TEST(Improve, NoCircleAroundATriangleOfALevelFacetHoldsAnotherVertex) {
    std::mt19937_64 random(2);
    Tin tin = built(sloping(0.0));
    ASSERT_EQ(integrate_checked(tin, {random_points(random, 150)}).broken, "");
    const MeshData data = tin.to_data();
    for (const auto& t : data.triangles) {
        const Point3 &a = data.vertices[t[0]], &b = data.vertices[t[1]], &c = data.vertices[t[2]];
        const long double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
        const long double twice = 2 * (bx * cy - by * cx);
        const long double x = (cy * (bx * bx + by * by) - by * (cx * cx + cy * cy)) / twice;
        const long double y = (bx * (cx * cx + cy * cy) - cx * (bx * bx + by * by)) / twice;
        const long double radius = std::hypot(x, y);
        for (const Point3& v : data.vertices)
            ASSERT_GT(std::hypot(v.x - a.x - x, v.y - a.y - y), radius * (1 - 1e-9L));
    }
}

TEST(Improve, GivesTheConstrainedDelaunayTriangulationAroundLines) {
    for (const double slope : {0.0, 1.0, 5.0}) {
        std::mt19937_64 random(3);
        Tin tin = built(sloping(slope));
        std::vector<Shape> shapes;
        for (int i = 0; i < 30; ++i) {
            shapes.push_back(random_points(random, 10));
            const Shape ends = random_points(random, 2);
            shapes.push_back(test::line({ends.paths[0].points[0], ends.paths[1].points[0]}));
        }
        ASSERT_EQ(integrate_checked(tin, shapes).broken, "");
        const Findings found = look_at(tin);
        EXPECT_GT(found.edges, 500);
        EXPECT_EQ(found.worse, 0) << "slope " << slope;
    }
}

TEST(Improve, HoldsInEveryFacetThatARingCrosses) {
    Tin tin = built(test::grid(6, 6, test::Diagonals::Alternate));
    Shape shape = test::ring({});
    for (int i = 0; i < 90; ++i)
        shape.paths[0].points.push_back({3.03 + 2.7 * std::cos(i * 0.0698131700797732),
                                         2.98 + 2.7 * std::sin(i * 0.0698131700797732)});
    ASSERT_EQ(integrate_checked(tin, {shape}).broken, "");
    const Findings found = look_at(tin);
    EXPECT_GT(found.edges, 50);
    EXPECT_EQ(found.worse, 0);
}

TEST(Improve, AtOnceAroundEachVertexOfAFacetThatIsKnown) {
    for (const double slope : {0.0, 2.0}) {
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> number(1.0, 49.0);
        Tin tin = built(sloping(slope));
        Surgery surgery(tin);
        Improver improver(surgery);
        for (int i = 0; i < 300; ++i) {
            const Point2 p{number(random), number(random)};
            const Location location = locate(tin, p, {0});
            ASSERT_EQ(location.kind, Location::Kind::InTriangle);
            const TriangleId t = location.side.triangle();
            const TriangleId next{static_cast<std::uint32_t>(tin.triangle_count())};
            surgery.split_triangle(t, {p.x, p.y, 0.7 * slope * (p.x + p.y)});
            const std::array outer{Side{t, 0}, Side{next, 0}, Side{{next.value + 1}, 0}};
            improver.improve_across(outer, true);
            ASSERT_EQ(look_at(tin).worse, 0) << "slope " << slope << ", vertex " << i;
        }
        EXPECT_GT(improver.edges_swapped(), 500u);
    }
}

TEST(Improve, HoldsAroundAShortLineInAFacetThatWasNotImproved) {
    std::mt19937_64 random(6);
    IntegrateOptions options;
    options.improve = Improve::None;
    Tin tin = built(sloping(1.0));
    ASSERT_TRUE(integrate(tin, std::vector{random_points(random, 100)}, options));
    const auto first = static_cast<std::uint32_t>(tin.vertex_count());
    Shape shape = test::line({});
    for (int i = 0; i < 60; ++i)
        shape.paths[0].points.push_back({10.0 + i * 0.5, 20.0 + 3.0 * std::sin(i * 0.4)});
    ASSERT_EQ(integrate_checked(tin, {shape}).broken, "");
    const Findings found = look_at(tin, first);
    EXPECT_GT(found.edges, 60);
    EXPECT_EQ(found.worse, 0);
    EXPECT_GT(look_at(tin).worse, 0);  // far from it all is as it was
}

TEST(Improve, HoldsAlongAnArcOfManyVerticesInOneFacet) {
    Tin tin = built(sloping(0.0));
    Shape shape = test::ring({});
    for (int i = 0; i < 700; ++i)
        shape.paths[0].points.push_back({25.0 + 20.0 * std::cos(i * 0.0089759790102565521),
                                         25.0 + 20.0 * std::sin(i * 0.0089759790102565521)});
    const auto outcome = integrate_checked(tin, {shape});
    ASSERT_EQ(outcome.broken, "");
    EXPECT_EQ(look_at(tin).worse, 0);
    // One after the other they would turn 64 each.
    EXPECT_LT(outcome.shape().edges_swapped, 40u * 700u);
}

TEST(Improve, LeavesWhatTheMarchMadeWhenAskedTo) {
    std::mt19937_64 random(1);
    IntegrateOptions options;
    options.improve = Improve::None;
    Tin tin = built(sloping(1.0));
    const auto outcome = integrate_checked(tin, {random_points(random, 200)}, options);
    ASSERT_EQ(outcome.broken, "");
    EXPECT_EQ(outcome.shape().edges_swapped, 0u);
    EXPECT_GT(look_at(tin).worse, 50);
}

TEST(Improve, DoesNotSwapAcrossFacetsThatLieInOnePlane) {
    // Each triangle of the mesh is a facet of its own, coplanar or not: its edges are the mesh's.
    MeshData data{{{0, 0, 0}, {10, 0, 0}, {10, 1, 0}, {0, 1, 0}, {5, 9, 0}},
                  {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}},
                  {}};
    Tin tin = built(data);
    const auto outcome = integrate_checked(tin, {test::line({{4, 0.1}, {5, 0.2}})});
    ASSERT_EQ(outcome.broken, "");
    bool found = false;
    for (const auto& t : tin.to_data().triangles)
        for (unsigned i = 0; i < 3; ++i)
            found = found || (t[i] == 0 && t[(i + 1) % 3] == 2);
    EXPECT_TRUE(found);
}

TEST(Improve, ReachesAFixedPoint) {
    std::mt19937_64 random(4);
    Tin tin = built(sloping(0.7));
    ASSERT_TRUE(integrate(tin, std::vector{random_points(random, 300)}, {}));
    Surgery surgery(tin);
    Improver improver(surgery);
    std::vector<VertexId> all;
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
        all.push_back({v});
    improver.improve(all);
    EXPECT_EQ(improver.edges_swapped(), 0u);
}

}  // namespace
}  // namespace tinsmith
