// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/surgery.hpp"

#include <algorithm>
#include <array>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/mesh/check.hpp"
#include "core/mesh/surface.hpp"
#include "core/mesh/walk.hpp"
#include "core/predicates/orientation.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

using Corners = std::array<std::uint32_t, 3>;

Corners corners(const Tin& tin, std::uint32_t t) {
    const auto& v = tin.triangle({t}).vertices;
    return {v[0].value, v[1].value, v[2].value};
}

bool is_constrained(const Tin& tin, std::uint32_t v, std::uint32_t w) {
    const Side side = find_edge(tin, {v}, {w});
    EXPECT_TRUE(side.valid()) << v << " " << w;
    return tin.is_constrained(side);
}

std::string violations(const Tin& tin) {
    std::string text;
    for (const Violation& violation : check_tin(tin))
        text += violation.law + ": " + violation.detail + "\n";
    return text;
}

/// A square of two triangles, (0, 1, 2) and (0, 2, 3), every edge of which is constrained.
MeshData square() {
    return {{{0, 0, 0}, {4, 0, 1}, {4, 4, 2}, {0, 4, 3}},
            {{0, 1, 2}, {0, 2, 3}},
            {{0, 1}, {1, 2}, {0, 2}, {2, 3}, {3, 0}}};
}

TEST(SplitTriangle, KeepsItsSlotAndAppendsTwo) {
    Tin tin = test::built(square());
    Surgery surgery(tin);
    const VertexId p = surgery.split_triangle({0}, {3, 1, 7});
    surgery.commit();
    EXPECT_EQ(p, VertexId{4});
    EXPECT_EQ(tin.vertex(p).point(), (Point3{3, 1, 7}));
    EXPECT_EQ(corners(tin, 0), (Corners{0, 1, 4}));
    EXPECT_EQ(corners(tin, 1), (Corners{0, 2, 3}));
    EXPECT_EQ(corners(tin, 2), (Corners{1, 2, 4}));
    EXPECT_EQ(corners(tin, 3), (Corners{2, 0, 4}));
    for (const std::uint32_t t : {0U, 2U, 3U})
        EXPECT_EQ(tin.facet({t}), FacetId{0});
    EXPECT_EQ(violations(tin), "");
}

TEST(SplitTriangle, KeepsTheMarksOfItsEdgesAndMarksNoNewOne) {
    Tin tin = test::built(square());
    Surgery surgery(tin);
    surgery.split_triangle({1}, {1, 3, 0});
    surgery.commit();
    EXPECT_TRUE(is_constrained(tin, 0, 2));
    EXPECT_TRUE(is_constrained(tin, 2, 3));
    EXPECT_TRUE(is_constrained(tin, 3, 0));
    for (const std::uint32_t v : {0U, 2U, 3U})
        EXPECT_FALSE(is_constrained(tin, v, 4));
    EXPECT_EQ(tin.to_data().constraints.size(), 5u);
}

TEST(SplitEdge, SplitsBothTrianglesAndKeepsMarksOnBothHalves) {
    Tin tin = test::built(square());
    Surgery surgery(tin);
    const VertexId p = surgery.split_edge({{0}, 2}, {2, 2, 1});  // 2 -> 0
    surgery.commit();
    EXPECT_EQ(p, VertexId{4});
    EXPECT_EQ(tin.triangle_count(), 4u);
    EXPECT_EQ(corners(tin, 0), (Corners{4, 1, 2}));
    EXPECT_EQ(corners(tin, 1), (Corners{0, 4, 3}));
    EXPECT_EQ(corners(tin, 2), (Corners{4, 0, 1}));
    EXPECT_EQ(corners(tin, 3), (Corners{4, 2, 3}));
    EXPECT_TRUE(is_constrained(tin, 0, 4));
    EXPECT_TRUE(is_constrained(tin, 4, 2));
    EXPECT_FALSE(is_constrained(tin, 4, 1));
    EXPECT_FALSE(is_constrained(tin, 4, 3));
    for (const auto& [v, w] : {std::pair{0U, 1U}, {1U, 2U}, {2U, 3U}, {3U, 0U}})
        EXPECT_TRUE(is_constrained(tin, v, w));
    EXPECT_EQ(tin.facet({2}), FacetId{0});
    EXPECT_EQ(tin.facet({3}), FacetId{1});
    EXPECT_EQ(violations(tin), "");
}

TEST(SplitEdge, OnTheBoundaryAppendsOneTriangleAndIsFoundThere) {
    Tin tin = test::built(square());
    Surgery surgery(tin);
    const VertexId p = surgery.split_edge(find_edge(tin, {0}, {1}), {1, 0, 0.25});
    surgery.commit();
    EXPECT_EQ(tin.triangle_count(), 3u);
    EXPECT_EQ(corners(tin, 0), (Corners{0, 4, 2}));
    EXPECT_EQ(corners(tin, 2), (Corners{4, 1, 2}));
    EXPECT_TRUE(is_constrained(tin, 0, 4));
    EXPECT_TRUE(is_constrained(tin, 4, 1));
    EXPECT_FALSE(is_constrained(tin, 4, 2));
    EXPECT_EQ(tin.origin(boundary_side_from(tin, p)), p);
    const auto near = tin.boundary().near({1.5, -1}, {1.5, 1});
    EXPECT_TRUE(std::find(near.begin(), near.end(), p) != near.end());
    EXPECT_EQ(violations(tin), "");
}

/// The square without a constraint on its diagonal, which is a facet's border.
Tin open_square() {
    MeshData data = square();
    data.constraints = {{0, 1}, {2, 3}};
    return test::built(data);
}

TEST(SplitAndPass, GivesTheNewSlotToTheHalfBesideTheOriginWhereTheWayGoesPastIt) {
    Tin tin = open_square();
    Surgery surgery(tin);
    const VertexId p = surgery.split_and_pass({{0}, 2}, {2, 2, 1}, true, false);  // 2 -> 0
    EXPECT_TRUE(surgery.is_fresh(find_edge(tin, p, {1})));
    surgery.commit();
    EXPECT_EQ(p, VertexId{4});
    EXPECT_EQ(corners(tin, 0), (Corners{4, 1, 2}));
    EXPECT_EQ(corners(tin, 1), (Corners{0, 4, 3}));
    EXPECT_EQ(corners(tin, 2), (Corners{4, 0, 1}));
    EXPECT_EQ(corners(tin, 3), (Corners{4, 2, 3}));
    EXPECT_TRUE(is_constrained(tin, 4, 1));
    EXPECT_FALSE(is_constrained(tin, 4, 3));
    EXPECT_FALSE(tin.separates_facets(find_edge(tin, {4}, {3})));
    EXPECT_TRUE(tin.separates_facets(find_edge(tin, {4}, {0})));
    EXPECT_TRUE(is_constrained(tin, 0, 1));
    EXPECT_TRUE(is_constrained(tin, 2, 3));
    EXPECT_EQ(violations(tin), "");
}

TEST(SplitAndPass, GivesTheNewSlotToTheHalfBesideTheDestinationElse) {
    Tin tin = open_square();
    Surgery surgery(tin);
    surgery.split_and_pass({{0}, 2}, {2, 2, 1}, false, true);
    surgery.commit();
    EXPECT_EQ(corners(tin, 0), (Corners{4, 1, 2}));
    EXPECT_EQ(corners(tin, 1), (Corners{4, 2, 3}));
    EXPECT_EQ(corners(tin, 2), (Corners{4, 0, 1}));
    EXPECT_EQ(corners(tin, 3), (Corners{0, 4, 3}));
    EXPECT_TRUE(is_constrained(tin, 4, 1));
    EXPECT_TRUE(tin.is_locked(find_edge(tin, {4}, {1})));
    EXPECT_FALSE(tin.is_locked(find_edge(tin, {4}, {3})));
    EXPECT_EQ(violations(tin), "");
}

TEST(SplitAndPass, TouchesNoTriangleThatTheWayDoesNotMeet) {
    for (const bool past_a : {true, false}) {
        Tin tin = test::built(test::grid(4, 4));
        const Side side = find_edge(tin, {6}, {12});  // a diagonal inside
        const bool past_origin = past_a == (tin.origin(side) == VertexId{6});
        const Side across = tin.twin(side);
        const Side missed = past_origin ? across.previous() : across.next();
        const TriangleId beyond = tin.twin(missed).triangle();
        Surgery surgery(tin);
        surgery.split_and_pass(side, {1.5, 1.5, 0}, past_origin, false);
        EXPECT_EQ(surgery.record().triangles.size(), 4u);
        for (const auto& [id, old] : surgery.record().triangles)
            EXPECT_NE(id, beyond) << past_a;
    }
}

TEST(SwapEdge, ExchangesTheDiagonalAndKeepsOuterMarks) {
    MeshData data = square();
    data.constraints = {{1, 2}, {3, 0}};
    Tin tin = test::built(data);
    Surgery surgery(tin);
    const Side diagonal = find_edge(tin, {0}, {2});
    const VertexId origin = tin.origin(diagonal);
    const Side swapped = surgery.swap_edge(diagonal);
    EXPECT_FALSE(find_edge(tin, {0}, {2}).valid());
    const auto& holder = tin.triangle(swapped.triangle()).vertices;
    EXPECT_TRUE(std::find(holder.begin(), holder.end(), origin) != holder.end());
    surgery.commit();
    EXPECT_EQ(tin.triangle_count(), 2u);
    EXPECT_FALSE(is_constrained(tin, 1, 3));
    EXPECT_FALSE(is_constrained(tin, 0, 1));
    EXPECT_TRUE(is_constrained(tin, 1, 2));
    EXPECT_FALSE(is_constrained(tin, 2, 3));
    EXPECT_TRUE(is_constrained(tin, 3, 0));
    EXPECT_EQ(violations(tin), "");
}

TEST(SwapEdge, TwiceGivesTheSameEdgeBack) {
    Tin tin = test::built(test::grid(3, 3, test::Diagonals::Alternate));
    const MeshData before = tin.to_data();
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            const Side twin = tin.twin(side);
            if (!twin.valid() ||
                !is_left(tin.plan(tin.origin(side)), tin.plan(tin.apex(twin)),
                         tin.plan(tin.apex(side))) ||
                !is_left(tin.plan(tin.apex(twin)), tin.plan(tin.destination(side)),
                         tin.plan(tin.apex(side))))
                continue;
            const auto ends = std::pair{tin.origin(side), tin.destination(side)};
            Surgery surgery(tin);
            const Side once = surgery.swap_edge(side);
            surgery.swap_edge(once);
            EXPECT_TRUE(find_edge(tin, ends.first, ends.second).valid());
            surgery.roll_back();
        }
    }
    EXPECT_TRUE(test::same_bytes(tin.to_data(), before));
}

TEST(AbsorbApex, GivesTheNeedleAndTheMarksToTheFacetAcross) {
    MeshData data{{{0, 0, 0}, {4, 0, 0}, {2, 0x1p-50, 0}, {2, -3, 5}, {2, 3, 5}},
                  {{0, 1, 2}, {1, 0, 3}, {2, 1, 4}, {0, 2, 4}},
                  {{0, 1}}};
    Tin tin = test::built(data);
    Surgery surgery(tin);
    surgery.absorb_apex({{0}, 0});  // 0 -> 1, the needle on its left
    surgery.commit();
    EXPECT_FALSE(find_edge(tin, {0}, {1}).valid());
    EXPECT_TRUE(is_constrained(tin, 0, 2));
    EXPECT_TRUE(is_constrained(tin, 2, 1));
    EXPECT_FALSE(is_constrained(tin, 2, 3));
    EXPECT_EQ(tin.facet({0}), FacetId{1});
    EXPECT_EQ(tin.facet({1}), FacetId{1});
    EXPECT_EQ(violations(tin), "");
}

TEST(MarkConstrained, MarksBothSidesAndIsFreshUntilCommitted) {
    Tin tin = test::built(test::grid(2, 2));
    Surgery surgery(tin);
    const Side side = find_edge(tin, {0}, {4});
    surgery.mark_constrained(side);
    EXPECT_TRUE(surgery.is_fresh(side));
    EXPECT_TRUE(surgery.is_fresh(tin.twin(side)));
    surgery.commit();
    EXPECT_TRUE(is_constrained(tin, 0, 4));
    Surgery second(tin);
    second.mark_constrained(find_edge(tin, {0}, {4}));
    EXPECT_FALSE(second.is_fresh(find_edge(tin, {0}, {4})));
    second.commit();
    EXPECT_EQ(violations(tin), "");
}

TEST(Surgery, RollsBackWhenNotCommitted) {
    Tin tin = test::built(square());
    const Tin before = tin;
    {
        Surgery surgery(tin);
        surgery.split_edge(find_edge(tin, {0}, {2}), {2, 2, 0});
        surgery.split_edge(find_edge(tin, {0}, {1}), {2, 0, 0});
    }
    EXPECT_TRUE(test::same_slots(tin, before));
    EXPECT_EQ(violations(tin), "");
}

TEST(Surgery, KeepsWhatMarksSayAboutFacetsThroughSwapsAndFreshFacets) {
    Tin tin = test::built(test::grid(3, 3));
    Surgery surgery(tin);
    const VertexId p = surgery.split_triangle({4}, {2.5, 0.25, 0});
    const Side spoke = find_edge(tin, p, {2});
    EXPECT_FALSE(tin.separates_facets(spoke));
    EXPECT_TRUE(tin.is_free(spoke));
    surgery.give_fresh_facet(spoke.triangle());
    EXPECT_TRUE(tin.separates_facets(spoke));
    EXPECT_TRUE(tin.separates_facets(tin.twin(spoke)));
    surgery.swap_edge(find_edge(tin, {5}, {10}));  // between two facets
    surgery.commit();
    EXPECT_EQ(violations(tin), "");
}

/// Random lawful changes, then laws, then all of it taken back.
void change_at_random(Tin& tin, Surgery& surgery, std::mt19937_64& random, int count) {
    for (int k = 0; k < count; ++k) {
        const TriangleId t{static_cast<std::uint32_t>(random() % tin.triangle_count())};
        const Side side(t, static_cast<unsigned>(random() % 3));
        const Side twin = tin.twin(side);
        const Point2 a = tin.plan(tin.origin(side)), b = tin.plan(tin.destination(side));
        const Point2 c = tin.plan(tin.apex(side));
        const Point2 d = twin.valid() ? tin.plan(tin.apex(twin)) : Point2{};
        const Point2 middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
        const Point2 centre{(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3};
        switch (random() % 5) {
            case 0:
                if (is_left(a, b, centre) && is_left(b, c, centre) && is_left(c, a, centre))
                    surgery.split_triangle(t, {centre.x, centre.y, elevation_in(tin, t, centre)});
                break;
            case 1:
                if (is_left(a, middle, c) && is_left(middle, b, c) &&
                    (!twin.valid() || (is_left(b, middle, d) && is_left(middle, a, d))))
                    surgery.split_edge(side, {middle.x, middle.y, 0.5});
                break;
            case 2:
                if (twin.valid() && is_left(a, d, c) && is_left(d, b, c)) surgery.swap_edge(side);
                break;
            case 3:
                if (twin.valid() && tin.separates_facets(side) && !tin.is_fixed(side) &&
                    is_left(a, middle, c) && is_left(middle, b, c) && is_left(b, middle, d) &&
                    is_left(middle, a, d))
                    surgery.split_and_pass(side, {middle.x, middle.y, 0.25}, random() % 2 == 0,
                                           random() % 3 == 0);
                break;
            default:
                surgery.mark_constrained(side);
        }
    }
}

TEST(Surgery, TakesAnyChangesBackBitForBit) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        std::mt19937_64 random(seed);
        Tin tin = test::built(seed % 2 == 0 ? test::ring_of_cells() : test::grid(3, 2));
        const Tin first = tin;
        Surgery one(tin);
        change_at_random(tin, one, random, 40);
        const UndoRecord record = one.commit();
        ASSERT_EQ(violations(tin), "") << "seed " << seed;

        const Tin second = tin;
        const auto near = tin.boundary().near({-1, -1}, {4, 4});
        Surgery two(tin);
        change_at_random(tin, two, random, 40);
        two.roll_back();
        ASSERT_TRUE(test::same_slots(tin, second)) << "seed " << seed;
        ASSERT_EQ(tin.boundary().near({-1, -1}, {4, 4}), near) << "seed " << seed;

        Surgery::undo(tin, record);
        ASSERT_TRUE(test::same_slots(tin, first)) << "seed " << seed;
        ASSERT_EQ(violations(tin), "") << "seed " << seed;
    }
}

TEST(Surgery, KeepsEveryMarkThroughAnyChanges) {
    // What was constrained stays covered by constrained edges: their whole length is kept.
    const auto constrained_length = [](const Tin& tin) {
        double sum = 0.0;
        const MeshData data = tin.to_data();
        for (const auto& [v, w] : data.constraints)
            sum += std::hypot(data.vertices[v].x - data.vertices[w].x,
                              data.vertices[v].y - data.vertices[w].y);
        return sum;
    };
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        std::mt19937_64 random(seed);
        MeshData data = test::grid(3, 3);
        data.constraints = {{0, 1}, {5, 10}, {6, 10}, {14, 15}};
        Tin tin = test::built(data);
        const double before = constrained_length(tin);
        Surgery surgery(tin);
        for (int k = 0; k < 60; ++k) {
            const TriangleId t{static_cast<std::uint32_t>(random() % tin.triangle_count())};
            const Side side(t, static_cast<unsigned>(random() % 3));
            const Point2 a = tin.plan(tin.origin(side)), b = tin.plan(tin.destination(side));
            surgery.split_edge(side, {(a.x + b.x) / 2, (a.y + b.y) / 2, 1});
        }
        surgery.commit();
        ASSERT_EQ(violations(tin), "") << "seed " << seed;
        ASSERT_NEAR(constrained_length(tin), before, 1e-9) << "seed " << seed;
    }
}

}  // namespace
}  // namespace tinsmith::core
