// SPDX-License-Identifier: Apache-2.0
#include "core/regions/region.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/mesh/check.hpp"
#include "core/mesh/surgery.hpp"
#include "core/mesh/walk.hpp"
#include "core/predicates/orientation.hpp"
#include "tests/unit/core/regions/integrated.hpp"

namespace tinsmith::core {
namespace {

using test::box;
using test::built;
using test::closed;
using test::grid;
using test::Integrated;
using test::integrated;
using test::reversed;
using test::slope;

constexpr double kTolerance = 1e-12;

/// Both areas of a region on the slope, and that the triangles are named once, in order.
void expect_area(const Region& region, double plan) {
    EXPECT_NEAR(region.plan_area, plan, kTolerance * (1 + plan));
    EXPECT_NEAR(region.surface_area, 1.25 * plan, kTolerance * (1 + plan));
    EXPECT_TRUE(std::is_sorted(region.triangles.begin(), region.triangles.end()));
    EXPECT_TRUE(std::adjacent_find(region.triangles.begin(), region.triangles.end()) ==
                region.triangles.end());
    EXPECT_EQ(region.triangles.empty(), plan == 0.0);
}

TEST(Region, OfARectangleAcrossManyTriangles) {
    Tin tin = built(slope(10, 10));
    expect_area(integrated(tin, {{box(1.25, 2.5, 7.75, 6.5)}}).region(tin), 6.5 * 4);
}

TEST(Region, OfAClockwiseRingIsTheSame) {
    Tin tin = built(slope(10, 10));
    const Integrated ring = integrated(tin, {{reversed(box(1.25, 2.5, 7.75, 6.5))}});
    expect_area(ring.region(tin), 26);
    expect_area(ring.region(tin, Winding::NonZero), 26);
}

TEST(Region, InsideOneTriangle) {
    Tin tin = built(test::one_triangle());
    const Integrated ring = integrated(tin, {{box(10, 10, 12, 13)}});
    const Region region = ring.region(tin);
    EXPECT_NEAR(region.plan_area, 6, kTolerance);
    EXPECT_NEAR(region.surface_area, 6 * std::sqrt(1 + 0.0625 + 0.25), 1e-11);
    EXPECT_EQ(region.triangles.size(), 2u);
}

TEST(Region, OfARingThatIsTheMeshsWholeBoundary) {
    Tin tin = built(slope(4, 3));
    const Region region = integrated(tin, {{box(0, 0, 4, 3)}}).region(tin);
    expect_area(region, 12);
    EXPECT_EQ(region.triangles.size(), tin.triangle_count());
}

TEST(Region, OfOneTriangleThatIsTheWholeMesh) {
    Tin tin = built(test::one_triangle(8));
    const Integrated ring = integrated(tin, {{closed({{0, 0}, {8, 0}, {0, 8}})}});
    EXPECT_EQ(ring.region(tin).triangles, std::vector<TriangleId>{{0}});
}

TEST(Region, OfABowTieIsBothWings) {
    Tin tin = built(slope(10, 10));
    const Integrated bow = integrated(tin, {{closed({{2, 2}, {8, 6}, {8, 2}, {2, 6}})}});
    expect_area(bow.region(tin), 12);
    expect_area(bow.region(tin, Winding::NonZero), 12);
}

TEST(Region, LeavesAHoleOut) {
    Tin tin = built(slope(10, 10));
    const Integrated ring = integrated(tin, {{box(1, 1, 9, 9), reversed(box(3.5, 3.5, 6.5, 5.5))}});
    expect_area(ring.region(tin), 64 - 6);
    expect_area(ring.region(tin, Winding::NonZero), 64 - 6);
}

TEST(Region, OfAHoleThatRunsTheSameWayDependsOnTheRule) {
    Tin tin = built(slope(10, 10));
    const Integrated ring = integrated(tin, {{box(1, 1, 9, 9), box(3.5, 3.5, 6.5, 5.5)}});
    expect_area(ring.region(tin), 64 - 6);
    expect_area(ring.region(tin, Winding::NonZero), 64);
}

TEST(Region, WithAnIslandInItsHole) {
    Tin tin = built(slope(10, 10));
    const Integrated ring =
        integrated(tin, {{box(1, 1, 9, 9), box(2.5, 2.5, 7.5, 7.5), box(4.25, 4.25, 5, 5.25)}});
    expect_area(ring.region(tin), 64 - 25 + 0.75);
}

TEST(Region, WithAHoleThatTouchesTheRing) {
    Tin tin = built(slope(10, 10));
    // In one vertex, in one point of an edge, and along an edge.
    const Integrated corner =
        integrated(tin, {{box(1, 1, 9, 9), closed({{1, 1}, {5.5, 3}, {3, 5.5}})}});
    expect_area(corner.region(tin), 64 - 8.125);
    tin = built(slope(10, 10));
    const Integrated point =
        integrated(tin, {{box(1, 1, 9, 9), closed({{4.5, 1}, {5, 3}, {4, 3}})}});
    expect_area(point.region(tin), 64 - 1);
    tin = built(slope(10, 10));
    const Integrated edge = integrated(tin, {{box(1, 1, 9, 9), box(3.5, 1, 5.5, 2.5)}});
    expect_area(edge.region(tin), 64 - 3);
}

TEST(Region, OfTwoPolygonsThatOverlap) {
    Tin tin = built(slope(10, 10));
    const Integrated one = integrated(tin, {{box(1.5, 1.5, 6.5, 6.5)}});
    const Integrated two = integrated(tin, {{box(4.25, 4.25, 8.75, 8.75)}});
    const Region first = one.region(tin), second = two.region(tin);
    expect_area(first, 25);
    expect_area(second, 20.25);
    std::vector<TriangleId> both;
    std::set_intersection(first.triangles.begin(), first.triangles.end(), second.triangles.begin(),
                          second.triangles.end(), std::back_inserter(both));
    EXPECT_FALSE(both.empty());
    EXPECT_LT(both.size(), first.triangles.size());
}

TEST(Region, OfARingAroundTheWholeMesh) {
    Tin tin = built(slope(5, 4));
    expect_area(integrated(tin, {{box(-1, -1, 6, 5)}}).region(tin), 20);
}

TEST(Region, OfARingAroundOneOfTwoComponents) {
    MeshData two = slope(2, 2);
    MeshData far = slope(3, 1);
    for (const Point3& v : far.vertices)
        two.vertices.push_back({v.x + 10, v.y, v.z + 7.5});
    for (const auto& t : far.triangles)
        two.triangles.push_back({t[0] + 9, t[1] + 9, t[2] + 9});
    Tin tin = built(two);
    expect_area(integrated(tin, {{box(9, -1, 14, 2)}}).region(tin), 3);
    // Around that one, and through the other.
    expect_area(integrated(tin, {{box(1.5, -1, 14, 3)}}).region(tin), 3 + 1);
    // The part of the outside where neither is.
    expect_area(integrated(tin, {{box(1.5, -1, 9, 3), box(20, 0, 21, 1)}}).region(tin), 1);
}

TEST(Region, PartlyOutsideEndsAtTheBoundary) {
    Tin tin = built(slope(10, 10));
    expect_area(integrated(tin, {{box(-3, 2.5, 4.5, 6)}}).region(tin), 4.5 * 3.5);
    expect_area(integrated(tin, {{box(6.5, -5, 20, 30)}}).region(tin), 35);
    // In and out many times: a comb from outside.
    std::vector<Point2> comb{{-1, 12}};
    for (int tooth = 0; tooth < 4; ++tooth)
        comb.insert(comb.end(), {{1.25 + 2 * tooth, 12},
                                 {1.25 + 2 * tooth, 4},
                                 {1.75 + 2 * tooth, 4},
                                 {1.75 + 2 * tooth, 12}});
    comb.insert(comb.end(), {{12, 12}, {12, 13}, {-1, 13}});
    expect_area(integrated(tin, {{closed(comb)}}).region(tin), 4 * 0.5 * 6);
}

TEST(Region, AroundAHoleOfTheMesh) {
    Tin tin = built(test::ring_of_cells());
    const Integrated around = integrated(tin, {{box(0.5, 0.5, 2.5, 2.5)}});
    EXPECT_NEAR(around.region(tin).plan_area, 3, kTolerance);
    const Integrated across = integrated(tin, {{box(1.5, 0.5, 2.5, 2.5)}});
    EXPECT_NEAR(across.region(tin).plan_area, 1.5, kTolerance);
}

TEST(Region, OfAnOpenLineIsEmpty) {
    Tin tin = built(slope(10, 10));
    const Integrated line = integrated(tin, test::line({{1, 1}, {8, 2}, {5, 8}, {1, 1}}));
    expect_area(line.region(tin), 0);
    expect_area(line.region(tin, Winding::NonZero), 0);
}

TEST(Region, OfASpikeIsWithoutTheSpike) {
    Tin tin = built(slope(10, 10));
    const Integrated ring =
        integrated(tin, {{closed({{2, 2}, {6, 2}, {6, 4}, {9.25, 4}, {6, 4}, {6, 6}, {2, 6}})}});
    expect_area(ring.region(tin), 16);
    expect_area(integrated(tin, {{closed({{1.5, 8.5}, {7.5, 9.25}})}}).region(tin), 0);
}

TEST(Region, OfARingTwiceInTheSameDirectionDependsOnTheRule) {
    Tin tin = built(slope(10, 10));
    const Integrated twice = integrated(tin, {{box(2.5, 2.5, 6, 7), box(2.5, 2.5, 6, 7)}});
    expect_area(twice.region(tin), 0);
    expect_area(twice.region(tin, Winding::NonZero), 3.5 * 4.5);
    const Integrated back = integrated(tin, {{box(2.5, 2.5, 6, 7), reversed(box(2.5, 2.5, 6, 7))}});
    expect_area(back.region(tin, Winding::NonZero), 0);
}

TEST(Region, StaysRightAfterSplitsByCrossingPolygons) {
    Tin tin = built(slope(10, 10));
    const Integrated ring = integrated(tin, {{closed({{1.1, 1.3}, {8.7, 2.9}, {4.3, 8.9}})}});
    const double area = ring.region(tin).plan_area;
    for (int k = 0; k < 6; ++k) {
        integrated(tin, {{box(0.5 + k, 0.7, 1.2 + k, 9.1)}});
        integrated(tin, test::line({{0.3, 0.3 + k}, {9.7, 9.1 - k}}));
        expect_area(ring.region(tin), area);
    }
    EXPECT_GT(tin.constraint_splits().size(), 30u);
}

TEST(Region, StaysRightAfterSwaps) {
    // First without improvement; then lines elsewhere in the same facets have edges swapped.
    Tin tin = built(test::one_triangle());
    const IntegrateOptions rough{.improve = Improve::None};
    const Integrated ring = integrated(tin, {{closed({{10, 10}, {40, 12}, {30, 41}})}}, rough);
    const Region before = ring.region(tin);
    std::uint64_t swaps = 0;
    for (int k = 0; k < 4; ++k)
        swaps += integrated(tin, {{box(14.0 + 4 * k, 14, 16.0 + 4 * k, 17)}}).report.edges_swapped;
    EXPECT_GT(swaps, 0u);
    const Region after = ring.region(tin);
    EXPECT_NEAR(after.plan_area, before.plan_area, 1e-10);
    EXPECT_NEAR(after.surface_area, before.surface_area, 1e-10);
    EXPECT_GT(after.triangles.size(), before.triangles.size());
}

TEST(Region, IsTheSameAfterAnUndo) {
    Tin tin = built(slope(10, 10));
    const Integrated ring = integrated(tin, {{box(1.25, 2.5, 7.75, 6.5)}});
    const Region before = ring.region(tin);
    const Integrated crossing = integrated(tin, {{box(3.3, 0.3, 5.1, 9.7)}});
    EXPECT_NE(ring.region(tin).triangles, before.triangles);
    take_back(tin, crossing.undo);
    const Region after = ring.region(tin);
    EXPECT_EQ(after.triangles, before.triangles);
    EXPECT_EQ(after.plan_area, before.plan_area);
    EXPECT_EQ(after.surface_area, before.surface_area);
}

TEST(Region, FollowsItsChainsWhereSnappingMovedThem) {
    // Every corner goes to a post half a cell away: the region is what the chains enclose, though
    // the input is farther from them than the triangles there are wide.
    Tin tin = built(slope(10, 10));
    const IntegrateOptions snapped{.snap = 0.6};
    const Integrated ring = integrated(tin, {{box(2.4, 2.4, 4.6, 4.6)}}, snapped);
    const Region region = ring.region(tin);
    EXPECT_EQ(tin.vertex_count(), 121u);
    EXPECT_GT(region.plan_area, 0.0);
    double enclosed = 0.0;
    ASSERT_EQ(ring.report.chains.size(), 1u);
    const auto& chain = ring.report.chains[0].vertices;
    EXPECT_EQ(chain.front(), chain.back());
    for (std::size_t i = 1; i < chain.size(); ++i) {
        const Point2 a = tin.plan(chain[i - 1]), b = tin.plan(chain[i]);
        enclosed += (a.x * b.y - a.y * b.x) / 2;
    }
    expect_area(region, enclosed);
}

TEST(Region, OfASnappedRingIsClosedHoweverItBeganAndEnded) {
    const IntegrateOptions snapped{.snap = 0.75};
    // Comes back to another post within snap of its beginning than the one it began at.
    Tin tin = built(slope(10, 10));
    EXPECT_NEAR(integrated(tin, {{box(2.4, 2.4, 4.6, 4.6)}}, snapped).region(tin).plan_area, 7.5,
                2);
    // Names its first point again at the end.
    tin = built(slope(10, 10));
    const Path again = closed({{2.4, 2.4}, {6.6, 2.4}, {6.6, 6.6}, {2.4, 6.6}, {2.4, 2.4}});
    const Integrated twice = integrated(tin, {{again}}, snapped);
    ASSERT_EQ(twice.report.chains.size(), 1u);
    EXPECT_EQ(twice.report.chains[0].vertices.front(), twice.report.chains[0].vertices.back());
    EXPECT_NEAR(twice.region(tin).plan_area, 4.2 * 4.2, 4 * 4.2 * 0.75);
    // Begins outside, within snap of vertices inside.
    tin = built(slope(10, 10));
    const Path outside = closed({{-0.25, 2.9}, {5, 3.5}, {5, 6.5}, {0.3, 3.4}});
    const Integrated home = integrated(tin, {{outside}}, {.snap = 0.5});
    EXPECT_FALSE(home.report.outside.empty());
    EXPECT_NEAR(home.region(tin).plan_area, 8, 5);
}

/// A ring as the march reports it where it passed the mesh by, within rounding of it perhaps.
Region region_of_passing_ring(const Tin& tin, const Path& ring) {
    const Shape shape{{ring}};
    std::vector<Point2> round = ring.points;
    round.push_back(round.front());
    const std::vector<OutsidePart> outside{{0, std::move(round)}};
    return find_region(tin, ConstraintHistory(tin), {shape, {}, outside}, Winding::NonZero);
}

/// Islands of one triangle each around a box of half width 8: four inside against its edges, then
/// four outside. Each touches its edge with one corner, or lies along it.
MeshData islands_at_box(bool along_it) {
    MeshData islands;
    for (const double inwards : {1.0, -1.0}) {
        for (const Point2 out : {Point2{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
            const auto first = static_cast<std::uint32_t>(islands.vertices.size());
            const auto put = [&](double depth, double aside) {
                const double d = 8 - depth * inwards, a = aside * inwards;
                islands.vertices.push_back({d * out.x + a * out.y, d * out.y - a * out.x, 0});
            };
            put(0, 1);
            put(2, 0);
            along_it ? put(0, -1) : put(2, 2);
            islands.triangles.push_back({first, first + 1, first + 2});
        }
    }
    return islands;
}

TEST(Region, OfIslandsThatTouchTheLineIsThoseInside) {
    // Exact, so that what touches a straight line still does.
    const auto turned = [](auto p) {
        const auto before = p;
        p.x -= before.y / 4;
        p.y += before.x / 4;
        return p;
    };
    Path ring = box(-8, -8, 8, 8);
    for (Point2& p : ring.points)
        p = turned(p);
    const std::vector<TriangleId> inside{{0}, {1}, {2}, {3}};
    for (const bool along_it : {false, true}) {
        MeshData islands = islands_at_box(along_it);
        for (Point3& v : islands.vertices)
            v = turned(v);
        for (auto& [a, b, c] : islands.triangles) {
            const auto& v = islands.vertices;
            if (orientation(v[a].plan(), v[b].plan(), v[c].plan()) == Orientation::Clockwise)
                std::swap(b, c);
        }
        for (unsigned first = 0; first < 3; ++first) {
            const Tin tin = built(islands);
            ASSERT_EQ(tin.components().size(), 8u);
            EXPECT_EQ(region_of_passing_ring(tin, ring).triangles, inside);
            EXPECT_EQ(region_of_passing_ring(tin, reversed(ring)).triangles, inside);
            for (auto& t : islands.triangles)
                std::rotate(t.begin(), t.begin() + 1, t.end());
        }
    }
}

TEST(Region, OfAnIslandWhoseFirstTriangleIsOnTheLineToWithinRounding) {
    // An ulp wide, and the line through it; what is beside it tells.
    for (const bool inside : {true, false}) {
        for (const double line : {4.0, std::nextafter(4.0, 0.0), std::nextafter(4.0, 9.0)}) {
            const double beside = inside ? 3 : 5;
            MeshData island{
                {{4, 1, 0}, {4, 3, 0}, {std::nextafter(4.0, beside), 2, 0}, {beside, 2.5, 0}},
                {{0, 1, 2}, {2, 1, 3}},
                {}};
            if (!inside)
                for (auto& t : island.triangles)
                    std::swap(t[1], t[2]);
            const Tin tin = built(island);
            ASSERT_EQ(tin.components(), std::vector<TriangleId>{{0}});
            EXPECT_EQ(region_of_passing_ring(tin, box(0, 0, line, 4)).triangles.size(),
                      inside ? 2u : 0u);
        }
    }
}

/// As the march leaves chains where rounding forbids to split the boundary: they end at a vertex
/// beside it. Here that vertex is 1/64 away, and the region may be off by the triangles between.
TEST(Region, OfAPathThatLeftTheMeshFromBesideTheBoundary) {
    for (const bool upper : {true, false}) {
        MeshData data = grid(4, 4);
        data.vertices[11].x = 1.0 / 64;
        Tin tin = built(data);
        const VertexId v1{11}, v2{12}, v3{13}, v4{14};  // the posts at y = 2
        Surgery surgery(tin);
        for (const auto& [a, b] : {std::pair{v1, v2}, {v2, v3}, {v3, v4}})
            surgery.mark_constrained(find_edge(tin, a, b));
        surgery.commit();
        const double y = upper ? 5 : -1;
        const Shape shape{{closed({{5, 2}, {-1, 2}, {-1, y}, {5, y}})}};
        const std::vector<Chain> chains{{0, {v4, v3, v2, v1}}};
        const std::vector<OutsidePart> outside{
            {0, {{5, 2}, {4, 2}}}, {0, {{1.0 / 64, 2}, {-1, 2}, {-1, y}, {5, y}, {5, 2}}}};
        const Region region =
            find_region(tin, ConstraintHistory(tin), {shape, chains, outside}, Winding::EvenOdd);
        EXPECT_NEAR(region.plan_area, 8.0, 1.0 / 64);
    }
}

}  // namespace
}  // namespace tinsmith::core
