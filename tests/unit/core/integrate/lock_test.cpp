// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/lock.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "core/mesh/check.hpp"
#include "core/mesh/surgery.hpp"
#include "core/mesh/walk.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

using test::built;
using test::grid;

Path path(std::vector<Point2> points, bool closed = false) {
    return {std::move(points), closed};
}

std::size_t locked_edges(const Tin& tin) {
    std::size_t count = 0;
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            const Side twin = tin.twin(side);
            if (tin.is_locked(side) && (!twin.valid() || side < twin)) ++count;
        }
    }
    return count;
}

bool is_locked(const Tin& tin, std::uint32_t v, std::uint32_t w) {
    const Side side = find_edge(tin, {v}, {w});
    EXPECT_TRUE(side.valid()) << v << " " << w;
    return side.valid() && tin.is_locked(side);
}

/// Locks, and expects the mesh to be valid and to have gained nothing.
LockReport lock(Tin& tin, const Path& line, double reach = 0.0, bool locked = true,
                Undo* undo = nullptr) {
    const MeshData before = tin.to_data();
    const auto report = lock_along(tin, line, reach, locked, undo);
    EXPECT_TRUE(test::same_bytes(tin.to_data(), before));
    EXPECT_TRUE(check_tin(tin).empty());
    if (report) return *report;
    ADD_FAILURE() << report.errors()[0].detail;
    return {};
}

ErrorCode refusal(Tin& tin, const Path& line, double reach = 0.0) {
    const Tin before = tin;
    const auto report = lock_along(tin, line, reach, true);
    EXPECT_TRUE(test::same_slots(tin, before));
    EXPECT_FALSE(report.ok());
    return report ? ErrorCode::StepBudget : report.errors()[0].code;
}

TEST(LockAlong, LocksTheEdgesOfAStraightRun) {
    Tin tin = built(grid(4, 4));
    const LockReport report = lock(tin, path({{1, 2}, {4, 2}}));
    EXPECT_EQ(report.edges, 3u);
    EXPECT_EQ(report.changed, 3u);
    EXPECT_DOUBLE_EQ(report.length, 3.0);
    EXPECT_TRUE(report.without_edge.empty());
    EXPECT_EQ(locked_edges(tin), 3u);
    for (std::uint32_t v = 11; v < 14; ++v)
        EXPECT_TRUE(is_locked(tin, v, v + 1));
}

TEST(LockAlong, TurnsWithTheLineAndClosesIt) {
    Tin tin = built(grid(4, 4));
    // Two sides along the grid, one along diagonals.
    const LockReport report = lock(tin, path({{1, 1}, {3, 1}, {3, 3}}, true));
    EXPECT_EQ(report.edges, 6u);
    EXPECT_NEAR(report.length, 4 + 2 * std::sqrt(2.0), 1e-14);
    EXPECT_TRUE(report.without_edge.empty());
    EXPECT_TRUE(is_locked(tin, 6, 12));
    EXPECT_TRUE(is_locked(tin, 12, 18));
}

TEST(LockAlong, DoesNotMindWhereTheLineHasItsPoints) {
    Tin tin = built(grid(4, 4));
    // Denser than the mesh, coarser, there and back, a point given twice.
    const LockReport report =
        lock(tin, path({{1, 2}, {1.25, 2}, {1.25, 2}, {2.5, 2}, {2.25, 2}, {4, 2}}));
    EXPECT_EQ(report.edges, 3u);
    EXPECT_TRUE(report.without_edge.empty());
}

TEST(LockAlong, LeavesEdgesAloneThatTheLineCoversInPart) {
    Tin tin = built(grid(4, 4));
    const LockReport report = lock(tin, path({{0.5, 2}, {3.75, 2}}));
    EXPECT_EQ(report.edges, 2u);
    ASSERT_EQ(report.without_edge.size(), 2u);
    EXPECT_EQ(report.without_edge[0], (std::vector<Point2>{{0.5, 2}, {1, 2}}));
    EXPECT_EQ(report.without_edge[1], (std::vector<Point2>{{3, 2}, {3.75, 2}}));
    // From both ends, but not the middle.
    Tin other = built(test::one_triangle(16));
    EXPECT_EQ(refusal(other, path({{0, 0}, {6, 0}, {6, -1}, {10, -1}, {10, 0}, {16, 0}})),
              ErrorCode::NoEdgeAlong);
}

TEST(LockAlong, NamesStretchesRoundCorners) {
    Tin tin = built(grid(4, 4));
    const LockReport report =
        lock(tin, path({{0, 1}, {1, 1}, {1.5, 1.75}, {2.5, 1.75}, {3, 1}, {4, 1}}));
    EXPECT_EQ(report.edges, 2u);
    ASSERT_EQ(report.without_edge.size(), 1u);
    EXPECT_EQ(report.without_edge[0],
              (std::vector<Point2>{{1, 1}, {1.5, 1.75}, {2.5, 1.75}, {3, 1}}));
}

TEST(LockAlong, ReachesEdgesBesideTheLineButNotAcrossIt) {
    Tin tin = built(grid(4, 4));
    const Path line = path({{1, 2.0625}, {4, 1.9375}});
    EXPECT_EQ(refusal(tin, line), ErrorCode::NoEdgeAlong);
    const LockReport middle = lock(tin, line, 0.03125);
    EXPECT_EQ(middle.edges, 1u);
    EXPECT_EQ(middle.without_edge.size(), 2u);
    const LockReport report = lock(tin, line, 0.0625 + 1e-3);
    EXPECT_EQ(report.edges, 3u);
    EXPECT_TRUE(report.without_edge.empty());
}

TEST(LockAlong, FindsEdgesWhereverTheLineIsOutside) {
    // Starts and ends outside, over the hole of the mesh and along its rim.
    Tin tin = built(test::ring_of_cells());
    const LockReport report = lock(tin, path({{-2, 1}, {5, 1}}));
    EXPECT_EQ(report.edges, 3u);
    ASSERT_EQ(report.without_edge.size(), 2u);
    Tin diagonal = built(test::ring_of_cells());
    const LockReport across = lock(diagonal, path({{-1, -1}, {4, 4}}));
    EXPECT_EQ(across.edges, 2u);
    EXPECT_EQ(across.without_edge.size(), 3u);
    // Beside the mesh all the way.
    Tin beside = built(grid(4, 4));
    EXPECT_EQ(lock(beside, path({{-0.125, -1}, {-0.125, 5}}), 0.25).edges, 4u);
}

TEST(LockAlong, LocksBoundaryEdges) {
    Tin tin = built(grid(3, 2));
    const LockReport report = lock(tin, path({{0, 0}, {3, 0}, {3, 2}, {0, 2}}, true));
    EXPECT_EQ(report.edges, 10u);
    EXPECT_EQ(locked_edges(tin), 10u);
}

TEST(LockAlong, UnlocksAndCountsWhatChanged) {
    Tin tin = built(grid(4, 4));
    lock(tin, path({{1, 2}, {4, 2}}));
    const LockReport again = lock(tin, path({{0, 2}, {4, 2}}));
    EXPECT_EQ(again.edges, 4u);
    EXPECT_EQ(again.changed, 1u);
    const LockReport back = lock(tin, path({{2, 2}, {4, 2}}), 0.0, false);
    EXPECT_EQ(back.edges, 2u);
    EXPECT_EQ(back.changed, 2u);
    EXPECT_EQ(locked_edges(tin), 2u);
    EXPECT_EQ(lock(tin, path({{2, 2}, {4, 2}}), 0.0, false).changed, 0u);
}

TEST(LockAlong, IsTakenBackBitForBit) {
    Tin tin = built(grid(4, 4));
    lock(tin, path({{0, 1}, {2, 1}}));
    const Tin before = tin;
    Undo undo;
    lock(tin, path({{1, 0}, {1, 4}}), 0.0, true, &undo);
    EXPECT_FALSE(test::same_slots(tin, before));
    take_back(tin, undo);
    EXPECT_TRUE(test::same_slots(tin, before));
    lock(tin, path({{0, 1}, {2, 1}}), 0.0, false, &undo);
    take_back(tin, undo);
    EXPECT_TRUE(test::same_slots(tin, before));
}

TEST(LockAlong, RefusesLinesThatAreNone) {
    Tin tin = built(grid(2, 2));
    EXPECT_EQ(refusal(tin, path({})), ErrorCode::LineTooShort);
    EXPECT_EQ(refusal(tin, path({{1, 1}, {1, 1}}, true)), ErrorCode::LineTooShort);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(refusal(tin, path({{0, 0}, {kInfinity, 0}})), ErrorCode::CoordinateNotFinite);
    EXPECT_EQ(refusal(tin, path({{0, 0}, {1e16, 0}})), ErrorCode::CoordinateOutOfRange);
    EXPECT_EQ(refusal(tin, path({{50, 50}, {60, 50}})), ErrorCode::NoEdgeAlong);
    // An edge crossed at right angles is not along the line.
    EXPECT_EQ(refusal(tin, path({{0.5, 0.25}, {1.5, 0.75}})), ErrorCode::NoEdgeAlong);
}

TEST(LockAlong, FindsEveryEdgeOfALineThatWasIntegrated) {
    for (const double offset : {0.0, 5e6}) {
        Tin tin = built(grid(8, 8, test::Diagonals::Alternate, 1.0, {offset, offset}));
        std::vector<Point2> points{{0.3, 0.7}, {7.1, 2.9}, {5.3, 7.7}, {1.9, 6.1}, {7.7, 5.3}};
        for (Point2& p : points)
            p = {p.x + offset, p.y + offset};
        const Shape shape{{path(points, true)}};
        ASSERT_TRUE(integrate(tin, {&shape, 1}, {}).ok());
        const LockReport report = lock(tin, shape.paths[0]);
        EXPECT_EQ(report.edges, tin.to_data().constraints.size());
        EXPECT_TRUE(report.without_edge.empty());
        for (const auto& [v, w] : tin.to_data().constraints)
            EXPECT_TRUE(is_locked(tin, v, w));
    }
}

/// A facet cut by a line, its triangles as rough as the march left them.
Tin facet_with_long_edges() {
    Tin tin = built(test::one_triangle());
    const Shape zigzag = test::line({{5, 5}, {80, 6}, {7, 8}, {60, 12}});
    EXPECT_TRUE(integrate(tin, {&zigzag, 1}, {.improve = Improve::None}).ok());
    return tin;
}

/// One edge at a time that a later request would swap: locked, it is not.
void expect_locks_to_survive(const Tin& rough, const Shape& later, Improve improve) {
    const IntegrateOptions options{.improve = improve};
    Tin free = rough;
    ASSERT_TRUE(integrate(free, {&later, 1}, options).ok());
    std::size_t kept = 0;
    for (std::uint32_t t = 0; t < rough.triangle_count(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            const VertexId v = rough.origin(side), w = rough.destination(side);
            if (rough.is_fixed(side) || find_edge(free, v, w).valid()) continue;
            Tin tin = rough;
            lock(tin, path({rough.plan(v), rough.plan(w)}));
            const LockReport found = lock(tin, path({rough.plan(v), rough.plan(w)}));
            ASSERT_TRUE(integrate(tin, {&later, 1}, options).ok());
            EXPECT_TRUE(check_tin(tin).empty());
            // Whole or split, the line from v to w is locked edges still.
            const LockReport after = lock(tin, path({rough.plan(v), rough.plan(w)}));
            EXPECT_TRUE(after.without_edge.empty());
            EXPECT_EQ(after.changed, 0u);
            EXPECT_DOUBLE_EQ(after.length, found.length);
            ++kept;
        }
    }
    EXPECT_GT(kept, 0u);
}

TEST(LockedEdges, SurviveStrictImprovement) {
    expect_locks_to_survive(facet_with_long_edges(), test::line({{4, 20}, {60, 20.5}}),
                            Improve::Strict);
}

TEST(LockedEdges, SurviveImprovementAcrossFacets) {
    const Tin rough = built(grid(6, 6, test::Diagonals::Alternate));
    expect_locks_to_survive(rough, test::line({{0.2, 3.1}, {5.7, 3.3}}), Improve::Paper);
}

TEST(LockedEdges, AreSplitByWhatCrossesThemAndBothHalvesStayLocked) {
    Tin tin = built(grid(4, 4));
    lock(tin, path({{0, 2}, {4, 2}}));
    const Shape across = test::line({{2.5, 0.5}, {2.5, 3.5}});
    ASSERT_TRUE(integrate(tin, {&across, 1}, {}).ok());
    const LockReport split = lock(tin, path({{0, 2}, {4, 2}}));
    EXPECT_EQ(split.edges, 5u);
    EXPECT_EQ(split.changed, 0u);
    EXPECT_EQ(locked_edges(tin), 5u);
}

TEST(LockAlong, StopsWhereItsBudgetEnds) {
    Tin tin = built(grid(20, 20));
    const Tin before = tin;
    const Path line = path({{0, 0}, {20, 0}, {20, 20}, {0, 20}});
    LockBudget roomy{100'000, {}};
    EXPECT_TRUE(lock_along(tin, line, 100.0, true, nullptr, &roomy).ok());
    EXPECT_LE(roomy.visits, 100'000u - 3u * 800u) << "each segment sees all triangles";
    Tin other = before;
    LockBudget tight{3 * 800, {}};
    const auto refused = lock_along(other, line, 100.0, true, nullptr, &tight);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.errors()[0].code, ErrorCode::CrossingBudget);
    EXPECT_TRUE(test::same_slots(other, before));
}

TEST(LockAlong, StopsAmidALineWhenToldTo) {
    Tin tin = built(grid(60, 60));
    const Tin before = tin;
    int asked = 0;
    LockBudget budget{UINT64_MAX, [&asked] { return ++asked == 3; }};
    const auto stopped =
        lock_along(tin, path({{0, 0}, {60, 0}, {60, 60}}), 1000.0, true, nullptr, &budget);
    ASSERT_FALSE(stopped.ok());
    EXPECT_EQ(stopped.errors()[0].code, ErrorCode::Cancelled);
    EXPECT_EQ(asked, 3);
    EXPECT_TRUE(test::same_slots(tin, before));
}

TEST(LockMarks, AreOnBothHalvesOfASplitEdge) {
    Tin tin = built(grid(2, 2));
    {
        Surgery surgery(tin);
        surgery.set_locked(find_edge(tin, {0}, {4}), true);  // inside
        surgery.set_locked(find_edge(tin, {0}, {1}), true);  // boundary
        const VertexId inside = surgery.split_edge(find_edge(tin, {0}, {4}), {0.5, 0.5, 0});
        const VertexId rim = surgery.split_edge(find_edge(tin, {0}, {1}), {0.5, 0, 0});
        surgery.commit();
        EXPECT_TRUE(is_locked(tin, 0, inside.value));
        EXPECT_TRUE(is_locked(tin, inside.value, 4));
        EXPECT_TRUE(is_locked(tin, 0, rim.value));
        EXPECT_TRUE(is_locked(tin, rim.value, 1));
    }
    EXPECT_EQ(locked_edges(tin), 4u);
    EXPECT_TRUE(tin.to_data().constraints.empty());
    EXPECT_TRUE(tin.constraint_splits().empty());
    EXPECT_TRUE(check_tin(tin).empty());
}

TEST(LockMarks, GoToBothSidesOfAnAbsorbedApex) {
    Tin tin = built(MeshData{{{0, 0, 0}, {4, 0, 0}, {2, 0x1p-50, 0}, {2, -3, 5}, {2, 3, 5}},
                             {{0, 1, 2}, {1, 0, 3}, {2, 1, 4}, {0, 2, 4}},
                             {}});
    Surgery surgery(tin);
    surgery.set_locked(find_edge(tin, {0}, {1}), true);
    surgery.absorb_apex({{0}, 0});
    surgery.commit();
    EXPECT_TRUE(is_locked(tin, 0, 2));
    EXPECT_TRUE(is_locked(tin, 2, 1));
    EXPECT_EQ(locked_edges(tin), 2u);
    EXPECT_TRUE(tin.to_data().constraints.empty());
    EXPECT_TRUE(check_tin(tin).empty());
}

TEST(LockMarks, MoveWithTheirEdgesWhenOthersSwap) {
    Tin tin = built(grid(1, 1));
    Surgery surgery(tin);
    surgery.set_locked(find_edge(tin, {0}, {1}), true);
    surgery.set_locked(find_edge(tin, {1}, {3}), true);
    surgery.swap_edge(find_edge(tin, {0}, {3}));
    surgery.commit();
    EXPECT_TRUE(is_locked(tin, 0, 1));
    EXPECT_TRUE(is_locked(tin, 1, 3));
    EXPECT_FALSE(is_locked(tin, 1, 2));
    EXPECT_EQ(locked_edges(tin), 2u);
    EXPECT_TRUE(check_tin(tin).empty());
}

}  // namespace
}  // namespace tinsmith::core
