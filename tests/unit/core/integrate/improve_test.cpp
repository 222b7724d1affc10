// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/improve.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

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
/// holds on all of them exactly for the constrained Delaunay triangulation.
Findings look_at(const Tin& tin) {
    Findings found;
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            if (tin.is_fixed(side) || tin.separates_facets(side)) continue;
            const Side across = tin.twin(side);
            if (across < side) continue;
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
