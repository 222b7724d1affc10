// SPDX-License-Identifier: Apache-2.0
#include "core/regions/coverage.hpp"

#include <algorithm>

#include "core/mesh/walk.hpp"
#include "tests/unit/core/regions/integrated.hpp"

namespace tinsmith::core {
namespace {

using test::box;
using test::integrated;

using Shapes = std::vector<std::size_t>;

Shapes list(std::span<const std::size_t> shapes) {
    return {shapes.begin(), shapes.end()};
}

VertexId vertex_at(const Tin& tin, Point2 p) {
    const Location found = locate(tin, p, tin.hint(p));
    EXPECT_EQ(found.kind, Location::Kind::OnVertex) << p.x << " " << p.y;
    return found.vertex;
}

TEST(Linework, NamesTheShapesAlongAnEdgeThatTheyShare) {
    Tin tin = test::built(test::grid(6, 6));
    const auto left = integrated(tin, {{box(1, 1, 3, 3)}});
    const auto right = integrated(tin, {{box(3, 2, 5, 4)}});
    const std::vector<Linework::Lines> lines{{70, right.report.chains}, {7, left.report.chains}};
    const Linework linework(ConstraintHistory(tin), lines);
    const auto along = [&](Point2 a, Point2 b) {
        return list(linework.along(vertex_at(tin, a), vertex_at(tin, b)));
    };
    EXPECT_EQ(along({1, 1}, {2, 1}), Shapes{7});
    EXPECT_EQ(along({3, 1}, {3, 2}), Shapes{7});
    EXPECT_EQ(along({3, 2}, {3, 3}), (Shapes{7, 70}));
    EXPECT_EQ(along({3, 3}, {3, 2}), (Shapes{7, 70}));
    EXPECT_EQ(along({3, 3}, {3, 4}), Shapes{70});
    EXPECT_EQ(along({2, 2}, {2, 3}), Shapes{});
    const Side shared = find_edge(tin, vertex_at(tin, {3, 2}), vertex_at(tin, {3, 3}));
    EXPECT_EQ(list(linework.along(tin, shared)), (Shapes{7, 70}));
    EXPECT_EQ(list(linework.along(tin, tin.twin(shared))), (Shapes{7, 70}));
}

TEST(Linework, NamesAShapeOnceHoweverOftenItRunsAlongAnEdge) {
    Tin tin = test::built(test::grid(6, 6));
    const auto spike = integrated(tin, test::line({{1, 1}, {4, 1}, {2, 1}}));
    const std::vector<Linework::Lines> lines{{3, spike.report.chains}};
    const Linework linework(ConstraintHistory(tin), lines);
    EXPECT_EQ(list(linework.along(vertex_at(tin, {2, 1}), vertex_at(tin, {3, 1}))), Shapes{3});
}

TEST(Linework, CoversEveryConstrainedEdgeAfterCrossingsAndUndo) {
    Tin tin = test::built(test::grid(6, 6, test::Diagonals::Alternate));
    const auto one = integrated(tin, {{box(0.7, 0.9, 4.1, 4.3)}});
    const auto two = integrated(tin, {{box(2.2, 2.1, 5.3, 5.7)}});
    const auto three = integrated(tin, test::line({{0.1, 5.2}, {5.9, 0.3}}));
    const auto expect_covered = [&tin](const std::vector<Linework::Lines>& lines) {
        const Linework linework(ConstraintHistory(tin), lines);
        for (const auto& [a, b] : tin.to_data().constraints)
            EXPECT_FALSE(linework.along({a}, {b}).empty()) << a << " " << b;
    };
    expect_covered({{1, one.report.chains}, {2, two.report.chains}, {3, three.report.chains}});
    take_back(tin, three.undo);
    expect_covered({{1, one.report.chains}, {2, two.report.chains}});
}

TEST(Coverage, NamesAllShapesThatContainATriangle) {
    Tin tin = test::built(test::grid(6, 6));
    const auto one = integrated(tin, {{box(1, 1, 4, 4)}});
    const auto two = integrated(tin, {{box(3, 3, 5, 5)}});
    const Region first = one.region(tin), second = two.region(tin);
    const std::vector<Coverage::Area> areas{{9, &second}, {4, &first}};
    const Coverage coverage(areas);
    const auto at = [&](Point2 p) {
        const Location found = locate(tin, p, tin.hint(p));
        EXPECT_EQ(found.kind, Location::Kind::InTriangle);
        return list(coverage.containing(found.side.triangle()));
    };
    EXPECT_EQ(at({1.5, 1.25}), Shapes{4});
    EXPECT_EQ(at({3.5, 3.25}), (Shapes{4, 9}));
    EXPECT_EQ(at({4.5, 4.25}), Shapes{9});
    EXPECT_EQ(at({0.5, 0.25}), Shapes{});
    EXPECT_EQ(coverage.triangles().size(), first.triangles.size() + second.triangles.size());
    EXPECT_TRUE(std::is_sorted(coverage.triangles().begin(), coverage.triangles().end()));
}

TEST(Coverage, OfNothingIsEmpty) {
    const Coverage coverage({});
    EXPECT_TRUE(coverage.containing({0}).empty());
    EXPECT_TRUE(coverage.triangles().empty());
}

}  // namespace
}  // namespace tinsmith::core
