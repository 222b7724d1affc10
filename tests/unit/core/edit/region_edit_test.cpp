// SPDX-License-Identifier: Apache-2.0
#include "core/edit/region_edit.hpp"

#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "core/edit/volume.hpp"
#include "core/mesh/check.hpp"
#include "core/mesh/walk.hpp"
#include "tests/support/same_tin.hpp"
#include "tests/unit/core/regions/integrated.hpp"

namespace tinsmith::core {
namespace {

using test::box;
using test::built;
using test::Integrated;
using test::integrated;

/// One large triangle on a plane.
Tin plain(double per_x = 0.0, double per_y = 0.0) {
    const auto z = [&](double x, double y) { return 400 + per_x * x + per_y * y; };
    return built(
        {{{0, 0, z(0, 0)}, {1000, 0, z(1000, 0)}, {0, 1000, z(0, 1000)}}, {{0, 1, 2}}, {}});
}

Strip rim(double x0, double y0, double x1, double y1, double width) {
    return {Strip::Kind::Rim, width, {{box(x0 + width, y0 + width, x1 - width, y1 - width)}}, {}};
}

/// With mitred corners, where distance is not width.
Strip taper(double x0, double y0, double x1, double y1, double width) {
    return {Strip::Kind::Taper,
            width,
            {{box(x0 - width, y0 - width, x1 + width, y1 + width)}},
            {{box(x0, y0, x1, y1)}}};
}

Result<EditReport> edit(Tin& tin, const Integrated& polygon, const RegionEdit& what,
                        Undo* undo = nullptr) {
    return edit_region(tin, polygon.outline(), Winding::EvenOdd, what, {}, undo);
}

/// Positions and corners of the triangles that are not in the region, by slot.
std::map<std::uint32_t, std::vector<double>> outside(const Tin& tin, const Region& region) {
    std::map<std::uint32_t, std::vector<double>> found;
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        if (std::binary_search(region.triangles.begin(), region.triangles.end(), TriangleId{t}))
            continue;
        for (const VertexId v : tin.triangle({t}).vertices) {
            const Point3 p = tin.vertex(v).point();
            found[t].insert(found[t].end(), {static_cast<double>(v.value), p.x, p.y, p.z});
        }
    }
    return found;
}

bool is_within(Point2 p, double x0, double y0, double x1, double y1) {
    return p.x >= x0 && p.x <= x1 && p.y >= y0 && p.y <= y1;
}

TEST(RegionEdit, APadIsFlatToTheBitAndItsVolumeThatOfTheFrustum) {
    for (const double width : {0.05, 2.0}) {
        Tin tin = plain();
        const Integrated pad = integrated(tin, {{box(100, 200, 200, 300)}});
        const auto before = outside(tin, pad.region(tin));
        const Tin untouched = tin;
        const auto report =
            edit(tin, pad, ElevationEdit{level_plane(412.5), rim(100, 200, 200, 300, width)});
        ASSERT_TRUE(report.ok());
        EXPECT_TRUE(check_tin(tin).empty());
        EXPECT_EQ(outside(tin, pad.region(tin)), before);
        for (std::uint32_t v = 0; v < tin.vertex_count(); ++v) {
            const bool within =
                is_within(tin.plan({v}), 100 + width, 200 + width, 200 - width, 300 - width);
            EXPECT_EQ(tin.vertex({v}).z, within ? 412.5 : 400.0);
        }
        const double base = 100.0 * 100.0, top = (100 - 2 * width) * (100 - 2 * width);
        const double frustum = 12.5 / 3 * (base + top + std::sqrt(base * top));
        EXPECT_NEAR(report->fill, frustum, 1e-9 * frustum);
        EXPECT_EQ(report->cut, 0.0);
        EXPECT_EQ(report->vertices_moved, 4U);
        EXPECT_EQ(report->max_elevation_change, 12.5);
        EXPECT_NEAR(report->area_affected, base, 1e-9 * base);
        // The same by the question of two meshes.
        const auto volume = volume_between(tin, all_triangles(tin), untouched);
        EXPECT_NEAR(volume->cut, frustum, 1e-9 * frustum);
    }
}

TEST(RegionEdit, APadOnASlopeIsFlatAndCutAndFillAreThoseOfItsPrisms) {
    Tin tin = plain(0.1, 0.03);
    const Integrated pad = integrated(tin, {{box(100, 100, 200, 200)}});
    const double level = 400 + 0.1 * 150 + 0.03 * 150;  // that of its middle: cut is fill
    const double width = 0.05;
    const auto report =
        edit(tin, pad, ElevationEdit{level_plane(level), rim(100, 100, 200, 200, width)});
    ASSERT_TRUE(report.ok());
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v) {
        if (is_within(tin.plan({v}), 100.05, 100.05, 199.95, 199.95)) {
            EXPECT_EQ(tin.vertex({v}).z, level);
        }
    }
    // Over the ring it is the integral of |0.1 u + 0.03 v| / 2 over a square of half side h:
    // b > a: h^3 (2 b + 2 a^2 / (3 b)); the strip has at most the rest of the border's wedge.
    const double a = 0.03, b = 0.1, h = 50 - width;
    const double inner = h * h * h * (2 * b + 2 * a * a / (3 * b)) / 2;
    const double strip = 4 * 100 * width * (0.13 * 50) / 2;
    EXPECT_NEAR(report->cut, report->fill, 1e-3 * inner) << "but for the strip's diagonals";
    EXPECT_GT(report->cut, inner * (1 - 1e-12));
    EXPECT_LT(report->cut, inner + strip);
}

TEST(RegionEdit, WithTheBorderOnlyTheTrianglesThatTouchItTilt) {
    Tin tin = built(test::grid(8, 8));
    const Integrated pad = integrated(tin, {{box(2.5, 2.5, 5.5, 5.5)}});
    const Region region = pad.region(tin);
    std::set<std::uint32_t> inside;
    for (const TriangleId t : region.triangles)
        for (const VertexId v : tin.triangle(t).vertices)
            inside.insert(v.value);
    const Tin before = tin;
    Undo undo;
    const auto report = edit(tin, pad, ElevationEdit{level_plane(-3), {}}, &undo);
    ASSERT_TRUE(report.ok());
    EXPECT_TRUE(check_tin(tin).empty());
    EXPECT_EQ(tin.triangle_count(), before.triangle_count());
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
        EXPECT_EQ(tin.vertex({v}).z, inside.count(v) != 0 ? -3.0 : before.vertex({v}).z);
    EXPECT_EQ(report->vertices_moved, inside.size());
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        const auto& corners = tin.triangle({t}).vertices;
        const bool touches = std::any_of(corners.begin(), corners.end(),
                                         [&](VertexId v) { return inside.count(v.value) != 0; });
        EXPECT_EQ(tin.facet({t}).value >= before.next_facet(), touches);
    }
    take_back(tin, undo);
    EXPECT_TRUE(test::same_tin(tin, before));
}

TEST(RegionEdit, ATaperClimbsEvenlyAndNothingBeyondMoves) {
    Tin tin = built(test::grid(20, 20, test::Diagonals::Alternate, 1.0));
    const Integrated pad = integrated(tin, {{box(8.5, 8.5, 11.5, 11.5)}});
    const double width = 4.75;
    Undo undo;
    const Tin before = tin;
    std::map<std::pair<double, double>, double> old;
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
        old[{tin.plan({v}).x, tin.plan({v}).y}] = tin.vertex({v}).z;
    const auto report =
        edit(tin, pad,
             ElevationEdit{ElevationEdit::Offset{3.0}, taper(8.5, 8.5, 11.5, 11.5, width)}, &undo);
    ASSERT_TRUE(report.ok());
    EXPECT_TRUE(check_tin(tin).empty());
    int between = 0;
    for (const auto& [place, z] : old) {
        const double dx = std::max({8.5 - place.first, place.first - 11.5, 0.0});
        const double dy = std::max({8.5 - place.second, place.second - 11.5, 0.0});
        const double share = std::max(0.0, 1 - std::sqrt(dx * dx + dy * dy) / width);
        between += share > 0.0 && share < 1.0;
        const Location here = locate(tin, {place.first, place.second}, {0});
        ASSERT_EQ(here.kind, Location::Kind::OnVertex);
        const bool is_between = share > 0.0 && share < 1.0;
        EXPECT_NEAR(tin.vertex(here.vertex).z, z + 3.0 * share, is_between ? 1e-12 : 0.0);
    }
    EXPECT_GT(between, 80);
    EXPECT_EQ(report->cut, 0.0);
    take_back(tin, undo);
    EXPECT_TRUE(test::same_tin(tin, before));
}

TEST(RegionEdit, SetThenStrict) {
    // After a pad was set on level ground, what is cut in later may not take its triangles and
    // those around for one plane.
    Tin tin = plain();
    const Integrated pad = integrated(tin, {{box(100, 100, 300, 300)}});
    ASSERT_TRUE(edit(tin, pad, ElevationEdit{level_plane(450), rim(100, 100, 300, 300, 5)}).ok());
    const Shape across = {{box(50, 150, 350, 250)}};
    verify::Verifier verifier(tin.to_data());
    const IntegrateOptions options;
    const auto report = integrate(tin, {&across, 1}, options);
    ASSERT_TRUE(report.ok());
    const auto broken = test::check_guarantees(verifier, {{&across, 1}, options, *report, tin});
    EXPECT_TRUE(broken.empty()) << broken[0];
}

TEST(RegionEdit, SmoothingDrawsEachVertexTowardsItsNeighbours) {
    for (const bool moves_border : {false, true}) {
        Tin tin = built(test::grid(8, 8, test::Diagonals::Alternate));
        const Integrated area = integrated(tin, {{box(1.5, 1.5, 6.5, 6.5)}});
        const Tin before = tin;
        std::map<std::uint32_t, std::set<std::uint32_t>> neighbours;
        for (std::uint32_t t = 0; t < tin.triangle_count(); ++t)
            for (const VertexId v : tin.triangle({t}).vertices)
                for (const VertexId w : tin.triangle({t}).vertices)
                    if (v != w) neighbours[v.value].insert(w.value);
        std::vector<double> z;
        for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
            z.push_back(tin.vertex({v}).z);
        for (int pass = 0; pass < 7; ++pass) {
            const std::vector<double> old = z;
            for (std::uint32_t v = 0; v < tin.vertex_count(); ++v) {
                const Point2 p = tin.plan({v});
                const bool strictly = p.x > 1.5 && p.x < 6.5 && p.y > 1.5 && p.y < 6.5;
                if (!(strictly || (moves_border && is_within(p, 1.5, 1.5, 6.5, 6.5)))) continue;
                double pull = 0, sum = 0;
                for (const std::uint32_t w : neighbours[v]) {
                    const Point2 q = tin.plan({w});
                    const double weight = 1 / std::hypot(p.x - q.x, p.y - q.y);
                    pull += weight * (old[w] - old[v]);
                    sum += weight;
                }
                z[v] = old[v] + pull / sum / 2;
            }
        }
        Undo undo;
        const auto report = edit(tin, area, SmoothEdit{7, moves_border}, &undo);
        ASSERT_TRUE(report.ok());
        EXPECT_TRUE(check_tin(tin).empty());
        for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
            EXPECT_NEAR(tin.vertex({v}).z, z[v], 1e-12);
        EXPECT_GT(report->vertices_moved, 20U);
        take_back(tin, undo);
        EXPECT_TRUE(test::same_tin(tin, before));
    }
    Tin level = plain();
    const Integrated area = integrated(level, {{box(100, 100, 300, 300)}});
    EXPECT_EQ(edit(level, area, SmoothEdit{100, true})->vertices_moved, 0U);
}

TEST(RegionEdit, RemovesAndKeeps) {
    Tin tin = built(test::grid(6, 6));
    const Integrated hole = integrated(tin, {{box(1.5, 1.5, 4.5, 4.5)}});
    const Tin before = tin;
    Undo undo;
    const auto removed = edit(tin, hole, TrimEdit{false}, &undo);
    ASSERT_TRUE(removed.ok());
    EXPECT_TRUE(check_tin(tin).empty());
    EXPECT_NEAR(removed->area_affected, 9.0, 1e-12);
    EXPECT_NEAR(volume_against(tin, all_triangles(tin), level_plane(0)).area, 27.0, 1e-12);
    EXPECT_EQ(hole.region(tin).triangles.size(), 0U);
    const auto nothing = edit(tin, hole, TrimEdit{false});
    ASSERT_FALSE(nothing.ok());
    EXPECT_EQ(nothing.errors()[0].code, ErrorCode::NothingInside);
    take_back(tin, undo);
    EXPECT_TRUE(test::same_tin(tin, before));

    const auto kept = edit(tin, hole, TrimEdit{true}, &undo);
    ASSERT_TRUE(kept.ok());
    EXPECT_TRUE(check_tin(tin).empty());
    EXPECT_EQ(hole.region(tin).triangles.size(), tin.triangle_count());
    EXPECT_NEAR(hole.region(tin).plan_area, 9.0, 1e-12);
    EXPECT_EQ(edit(tin, hole, TrimEdit{true})->triangles_removed, 0U) << "it is that already";
    const auto all = edit(tin, hole, TrimEdit{false});
    ASSERT_FALSE(all.ok());
    EXPECT_EQ(all.errors()[0].code, ErrorCode::NothingLeft);
    take_back(tin, undo);
    EXPECT_TRUE(test::same_tin(tin, before));
}

TEST(RegionEdit, VerticesThatARemovalPartedMoveAsOne) {
    Tin tin = built(test::grid(4, 4));
    const Integrated corner = integrated(tin, {{box(0, 0, 2, 2)}});
    const Integrated other = integrated(tin, {{box(2, 2, 4, 4)}});
    const Integrated both = integrated(tin, {{box(0, 0, 2, 2), box(2, 2, 4, 4)}});
    ASSERT_TRUE(edit(tin, both, TrimEdit{true}).ok());
    ASSERT_EQ(tin.components().size(), 2U);
    const auto at_the_middle = [&tin] {
        std::set<double> found;
        for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
            if (tin.plan({v}) == Point2{2, 2}) found.insert(tin.vertex({v}).z);
        return found;
    };
    const auto old = at_the_middle();
    ASSERT_TRUE(edit(tin, corner, ElevationEdit{level_plane(9), {}}).ok());
    EXPECT_EQ(at_the_middle(), std::set<double>{9.0});
    ASSERT_TRUE(edit(tin, other, ElevationEdit{level_plane(5), rim(2, 2, 4, 4, 0.25)}).ok());
    EXPECT_EQ(at_the_middle(), std::set<double>{9.0}) << "it is of the border, and beyond it";
    ASSERT_TRUE(edit(tin, both, SmoothEdit{3, true}).ok());
    EXPECT_EQ(at_the_middle().size(), 1U);
    EXPECT_TRUE(check_tin(tin).empty());
}

TEST(RegionEdit, APolygonBeyondTheMeshIsEditedWhereItLiesOnIt) {
    Tin tin = built(test::grid(4, 4));
    const Integrated pad = integrated(tin, {{box(2.5, -1, 6, 2.5)}});
    ASSERT_TRUE(edit(tin, pad, ElevationEdit{level_plane(7), rim(2.5, -1, 6, 2.5, 0.5)}).ok());
    EXPECT_TRUE(check_tin(tin).empty());
    const Location corner = locate(tin, {4, 0}, {0});
    EXPECT_EQ(tin.vertex(corner.vertex).z, 7.0) << "inside the polygon, at the mesh's corner";
    // A ring that misses the mesh, though the polygon does not.
    const Integrated edge = integrated(tin, {{box(-3, 1, 0.25, 3)}});
    const auto report = edit(tin, edge, ElevationEdit{level_plane(7), rim(-3, 1, 0.25, 3, 0.5)});
    ASSERT_TRUE(report.ok());
    const Location strip = locate(tin, {0, 2}, {0});
    EXPECT_NEAR(tin.vertex(strip.vertex).z, 0.5 + (7 - 0.5) * 0.5, 1e-12) << "it takes a share";
}

TEST(RegionEdit, TellsItsProgress) {
    const Tin before = built(test::grid(8, 8));
    const RegionEdit lower = ElevationEdit{level_plane(1), rim(2.5, 2.5, 5.5, 5.5, 0.5)};
    for (const RegionEdit& any : {lower, RegionEdit(SmoothEdit{4, true})}) {
        Tin tin = before;
        const Integrated pad = integrated(tin, {{box(2.5, 2.5, 5.5, 5.5)}});
        std::vector<double> told;
        EditLimits limits;
        limits.progress = [&told](double share) { told.push_back(share); };
        ASSERT_TRUE(edit_region(tin, pad.outline(), Winding::EvenOdd, any, limits).ok());
        EXPECT_GE(told.size(), 2U);
        EXPECT_TRUE(std::ranges::is_sorted(told));
        EXPECT_GE(told.back(), 0.5);
        EXPECT_LE(told.back(), 1.0);
    }
}

TEST(RegionEdit, AnErrorLeavesTheMeshAsItWas) {
    Tin tin = built(test::grid(8, 8));
    const Integrated pad = integrated(tin, {{box(2.5, 2.5, 5.5, 5.5)}});
    const Tin before = tin;
    const RegionEdit high = ElevationEdit{level_plane(1e300), rim(2.5, 2.5, 5.5, 5.5, 0.5)};
    const auto refused = edit(tin, pad, high);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.errors()[0].code, ErrorCode::CoordinateOutOfRange);
    EXPECT_TRUE(test::same_tin(tin, before));
    EditLimits limits;
    limits.ids.facets = tin.next_facet() + 3;
    const RegionEdit lower = ElevationEdit{level_plane(1), rim(2.5, 2.5, 5.5, 5.5, 0.5)};
    const auto used_up = edit_region(tin, pad.outline(), Winding::EvenOdd, lower, limits);
    ASSERT_FALSE(used_up.ok());
    EXPECT_EQ(used_up.errors()[0].code, ErrorCode::IdBudget);
    EXPECT_TRUE(test::same_tin(tin, before));
    limits = {};
    limits.cancelled = [] { return true; };
    for (const RegionEdit& any : {lower, RegionEdit(SmoothEdit{3, true}), RegionEdit(TrimEdit{})}) {
        EXPECT_FALSE(edit_region(tin, pad.outline(), Winding::EvenOdd, any, limits).ok());
        EXPECT_TRUE(test::same_tin(tin, before));
    }
}

}  // namespace
}  // namespace tinsmith::core
