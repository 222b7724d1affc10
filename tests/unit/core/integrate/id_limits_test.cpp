// SPDX-License-Identifier: Apache-2.0
// Where the numbers of vertices, triangles and facets end: nothing wraps, nothing is half done.
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::built;
using test::grid;
using test::line;
using test::ring;

using SetLimit = std::function<void(IntegrateOptions&, std::size_t)>;

/// Tries limits from `from` on until one is enough, which must come within `most`: refused with the
/// mesh as it was before, and what is done stays within the limit.
void try_limits(const std::vector<Shape>& shapes, IntegrateOptions options, std::size_t from,
                std::size_t most, const SetLimit& set_limit,
                const std::function<std::size_t(const Tin&)>& used) {
    const Tin before = built(grid(6, 6, test::Diagonals::Alternate));
    for (std::size_t limit = from; limit <= from + most; ++limit) {
        Tin tin = before;
        set_limit(options, limit);
        const auto report = integrate(tin, shapes, options);
        if (report) {
            EXPECT_GT(limit, from) << "no limit was ever in the way";
            EXPECT_LE(used(tin), limit);
            EXPECT_TRUE(test::check_valid(tin).empty());
            return;
        }
        ASSERT_EQ(report.errors()[0].code, ErrorCode::IdBudget) << limit;
        ASSERT_TRUE(test::same_slots(tin, before)) << limit;
        ASSERT_EQ(tin.next_facet(), before.next_facet()) << limit;
    }
    FAIL() << "refused with room for " << most << " more";
}

const std::vector<Shape> kShapes{ring({{0.6, 0.7}, {5.1, 0.9}, {5.3, 5.4}, {0.2, 4.8}}),
                                 line({{-1.0, 3.1}, {7.0, 2.9}})};

TEST(IdLimits, EndARequestBeforeTheLastTriangleIsNumbered) {
    try_limits(
        kShapes, {}, built(grid(6, 6)).triangle_count(), 200,
        [](IntegrateOptions& options, std::size_t limit) { options.ids.triangles = limit; },
        [](const Tin& tin) { return tin.triangle_count(); });
}

TEST(IdLimits, EndARequestBeforeTheLastVertexIsNumbered) {
    try_limits(
        kShapes, {}, built(grid(6, 6)).vertex_count(), 200,
        [](IntegrateOptions& options, std::size_t limit) { options.ids.vertices = limit; },
        [](const Tin& tin) { return tin.vertex_count(); });
}

TEST(IdLimits, HoldForPointsAlone) {
    Shape points;
    for (double i = 0.0; i < 20.0; ++i)
        points.paths.push_back({{{0.3 + 0.25 * i, 2.6 + 0.01 * i}}});
    try_limits(
        {points}, {}, built(grid(6, 6)).triangle_count(), 100,
        [](IntegrateOptions& options, std::size_t limit) { options.ids.triangles = limit; },
        [](const Tin& tin) { return tin.triangle_count(); });
}

TEST(IdLimits, EndARequestThatSetsElevationsWithTheLastFacet) {
    Shape first{{{{{0.5, 0.5}, {3.5, 1.25}}, false, {4.0, 5.0}}}};
    Shape second{{{{{0.5, 4.5}, {5.5, 4.25}}, false, {4.0, 5.0}}}};
    try_limits(
        {first, second}, {}, built(grid(6, 6)).next_facet(), 400,
        [](IntegrateOptions& options, std::size_t limit) { options.ids.facets = limit; },
        [](const Tin& tin) { return std::size_t{tin.next_facet()}; });
}

TEST(IdLimits, EndARequestThatSwapsAcrossFacetsWithTheLastFacet) {
    IntegrateOptions options;
    options.improve = Improve::Paper;
    try_limits(
        kShapes, options, built(grid(6, 6)).next_facet(), 400,
        [](IntegrateOptions& o, std::size_t limit) { o.ids.facets = limit; },
        [](const Tin& tin) { return std::size_t{tin.next_facet()}; });
}

TEST(IdLimits, AreWhatIdsCanCount) {
    const IdLimits limits;
    // The last ids are valid, and no side of the last triangle is the invalid one.
    EXPECT_TRUE(VertexId{static_cast<std::uint32_t>(limits.vertices - 1)}.valid());
    const TriangleId last{static_cast<std::uint32_t>(limits.triangles - 1)};
    EXPECT_TRUE(Side(last, 2).valid());
    EXPECT_EQ(Side(last, 2).triangle(), last);
    EXPECT_EQ(limits.facets - 1, std::size_t{FacetId{}.value} - 2);
}

}  // namespace
}  // namespace tinsmith
