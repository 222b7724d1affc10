// SPDX-License-Identifier: Apache-2.0
#include "core/edit/volume.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/edit/cutout.hpp"
#include "core/edit/spot.hpp"
#include "tests/support/random_input.hpp"
#include "tests/unit/core/regions/integrated.hpp"

namespace tinsmith {
namespace {

using core::Shape;
using core::Tin;
using core::Volume;

void expect_close(double found, double right, const char* what) {
    EXPECT_LE(std::fabs(found - right), 1e-12 * std::max(std::fabs(right), 1e-3))
        << what << ": " << found;
}

void expect_volume(const Volume& found, double cut, double fill, double area) {
    expect_close(found.cut, cut, "cut");
    expect_close(found.fill, fill, "fill");
    expect_close(found.area, area, "area");
    expect_close(found.cut_area + found.fill_area, found.area, "areas");
}

core::Cutout cut(const Tin& tin, const Shape& shape) {
    auto found = core::cut_out(tin, shape, core::Winding::EvenOdd);
    EXPECT_TRUE(found.ok());
    return std::move(*found);
}

Volume against(const Tin& tin, const Shape& shape, const core::Plane& plane) {
    const core::Cutout part = cut(tin, shape);
    return core::volume_against(part.tin, part.region.triangles, plane);
}

Volume between(const Tin& a, const Tin& b) {
    auto found = core::volume_between(a, core::all_triangles(a), b);
    EXPECT_TRUE(found.ok());
    return *found;
}

Volume between(const Tin& a, const Shape& shape, const Tin& b) {
    const core::Cutout part = cut(a, shape);
    return *core::volume_between(part.tin, part.region.triangles, b);
}

/// A pyramid of that height over a square around the origin.
Tin pyramid(double half, double height) {
    return test::built(
        {{{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}, {0, 0, height}},
         {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
         {}});
}

/// A grid in one plane.
Tin tilted(unsigned cells, double step, double at, double per_x, double per_y,
           core::Point2 origin = {}, test::Diagonals diagonals = test::Diagonals::Alternate) {
    core::MeshData mesh = test::grid(cells, cells, diagonals, step, origin);
    for (core::Point3& v : mesh.vertices)
        v.z = at + per_x * v.x + per_y * v.y;
    return test::built(mesh);
}

Shape box(double x0, double y0, double x1, double y1) {
    return {{test::box(x0, y0, x1, y1)}};
}

TEST(Volume, OfAPyramid) {
    const Tin tin = pyramid(3.0, 7.0);
    const auto all = core::all_triangles(tin);
    expect_volume(core::volume_against(tin, all, core::level_plane(0)), 36.0 * 7.0 / 3.0, 0, 36);
    // Above z a pyramid similar to the whole is left; below, what that leaves of a prism.
    const double z = 2.5, scale = (7.0 - z) / 7.0;
    const double above = 36.0 * 7.0 / 3.0 * scale * scale * scale;
    const double below = above - 36.0 * 7.0 / 3.0 + 36.0 * z;
    const Volume found = core::volume_against(tin, all, core::level_plane(z));
    expect_volume(found, above, below, 36);
    expect_close(found.cut_area, 36.0 * scale * scale, "area of cut");
    expect_volume(core::volume_against(tin, all, core::level_plane(9)), 0,
                  36.0 * 9.0 - 36.0 * 7.0 / 3.0, 36);
}

TEST(Volume, OfATiltedPlaneAgainstALevel) {
    const Tin tin = tilted(7, 1.5, 1.0, 0.25, 0.0);
    const double width = 10.5, cross = 6.2, z = 1.0 + 0.25 * cross;
    const double cut_length = width - cross;
    const Volume found = core::volume_against(tin, core::all_triangles(tin), core::level_plane(z));
    expect_volume(found, 0.125 * cut_length * cut_length * width, 0.125 * cross * cross * width,
                  width * width);
    expect_close(found.cut_area, cut_length * width, "area of cut");
}

TEST(Volume, OfAPrismBetweenParallelPlanes) {
    const core::Plane plane = core::sloping_plane(0.3, 125.0, {2, 3, 4});
    const Tin tin = tilted(5, 2.0, plane.elevation({0, 0}) + 1.25, plane.per_x, plane.per_y);
    expect_volume(core::volume_against(tin, core::all_triangles(tin), plane), 125.0, 0, 100.0);
    expect_volume(against(tin, box(1, 2.5, 8.25, 4), plane), 7.25 * 1.5 * 1.25, 0, 7.25 * 1.5);
}

TEST(Volume, BetweenTwoTiltedPlanesThatCross) {
    // The difference is 0.3 x + 0.1 y - 1.1 on [0, 10.5]^2.
    const Tin a = tilted(7, 1.5, 1.0, 0.25, 0.125);
    const Tin b = tilted(5, 2.1, 2.1, -0.05, 0.025, {}, test::Diagonals::Falling);
    const double w = 10.5;
    const auto corner = [](double c, double px, double py) { return c * c * c / (6 * px * py); };
    // Below zero: the corner at the origin, a triangle of 11/3 by 11, less its tip beyond y = w.
    const double fill = corner(1.1, 0.3, 0.1) - corner(1.1 - 0.1 * w, 0.3, 0.1);
    const double net = w * w * (0.3 * w / 2 + 0.1 * w / 2 - 1.1);
    expect_volume(between(a, b), net + fill, fill, w * w);
    expect_volume(between(b, a), fill, net + fill, w * w);
    expect_volume(core::volume_against(a, core::all_triangles(a), {{0, 0, 2.1}, -0.05, 0.025}),
                  net + fill, fill, w * w);
}

TEST(Volume, InPolygonsWithHoles) {
    const Tin tin = tilted(8, 1.25, 5.0, 0.5, -0.25);
    const Shape shape{{test::box(1, 1, 9, 8), test::box(2.2, 2, 4, 4.6),
                       test::reversed(test::box(5, 5, 7.5, 6))}};
    const auto moment = [](double x0, double y0, double x1, double y1) {
        return (x1 - x0) * (y1 - y0) * (5.0 + 0.5 * (x0 + x1) / 2 - 0.25 * (y0 + y1) / 2);
    };
    const double area = 8 * 7 - 1.8 * 2.6 - 2.5;
    const double volume = moment(1, 1, 9, 8) - moment(2.2, 2, 4, 4.6) - moment(5, 5, 7.5, 6);
    expect_volume(against(tin, shape, core::level_plane(0)), volume, 0, area);
    expect_volume(against(tin, shape, core::level_plane(20)), 0, 20 * area - volume, area);
    expect_volume(between(tin, shape, tilted(3, 4.0, 20, 0, 0)), 0, 20 * area - volume, area);
    expect_close(cut(tin, shape).shape_area, area, "area of the shape");
}

TEST(Volume, OnlyWhereBothSurfacesAre) {
    const Tin tin = tilted(4, 1.0, 3.0, 0, 0);
    const Tin beside = tilted(4, 1.0, 1.0, 0, 0, {2.5, 1.0});
    expect_volume(between(tin, beside), 1.5 * 3 * 2, 0, 1.5 * 3);
    EXPECT_EQ(between(tin, tilted(4, 1.0, 1.0, 0, 0, {9, 9})).area, 0.0);
    const Tin ring = test::built(test::ring_of_cells());
    EXPECT_EQ(between(tilted(1, 3.0, 0, 0, 0), ring).area, 8.0);

    const core::Cutout part = cut(tin, box(2, 1, 7, 3));
    expect_close(part.region.plan_area, 4, "on the mesh");
    expect_close(part.shape_area, 10, "in all");
    const core::Cutout around = cut(ring, box(-1, -1, 6, 6));
    expect_close(around.region.plan_area, 8, "around it all");
    expect_close(around.shape_area, 49, "around it all");
    EXPECT_TRUE(cut(ring, box(1.25, 1.25, 1.5, 1.5)).region.triangles.empty());
    EXPECT_TRUE(cut(ring, box(10, 10, 11, 11)).region.triangles.empty());
}

TEST(Volume, AtMapCoordinates) {
    const core::Point2 origin{500000.3, 5000000.7};
    const core::Plane plane = core::sloping_plane(0.3, 125.0, {origin.x, origin.y, 400});
    core::MeshData mesh = test::grid(7, 7, test::Diagonals::Alternate, 30.0, origin);
    for (core::Point3& v : mesh.vertices)
        v.z = plane.elevation(v.plan()) + 1.25;
    const Tin tin = test::built(mesh);
    const core::Point2 far{tin.bounds().max.x, tin.bounds().max.y};
    const double area = (far.x - origin.x) * (far.y - origin.y);
    const auto near = [](double found, double right) {
        EXPECT_LE(std::fabs(found / right - 1), 1e-12) << found;
    };
    const Volume found = core::volume_against(tin, core::all_triangles(tin), plane);
    near(found.area, area);
    near(found.cut, 1.25 * area);
    // Corners that the lines of the grid and its diagonals pass by.
    const double x0 = origin.x + 17.37, x1 = origin.x + 151.91;
    const double y0 = origin.y + 8.73, y1 = origin.y + 188.11;
    const Volume part = against(tin, box(x0, y0, x1, y1), plane);
    near(part.area, (x1 - x0) * (y1 - y0));
    near(part.cut, 1.25 * (x1 - x0) * (y1 - y0));
    core::MeshData other = test::grid(9, 9, test::Diagonals::Rising, 20.0, {x0, y0});
    for (core::Point3& v : other.vertices)
        v.z = plane.elevation(v.plan());
    const Tin coarse = test::built(other);
    const double common = (coarse.bounds().max.x - x0) * (coarse.bounds().max.y - y0);
    near(between(tin, coarse).area, common);
    near(between(tin, coarse).cut, 1.25 * common);
}

TEST(Volume, AddsUpOverASplitPolygon) {
    const Tin tin = test::built(test::grid(9, 9, test::Diagonals::Alternate));
    const core::Plane plane = core::sloping_plane(0.07, 33.0, {4, 4, 0.6});
    const Volume whole = against(tin, box(0.7, 1.1, 8.3, 7.9), plane);
    const Volume left = against(tin, box(0.7, 1.1, 3.3, 7.9), plane);
    const Volume right = against(tin, box(3.3, 1.1, 8.3, 7.9), plane);
    expect_close(left.cut + right.cut, whole.cut, "cut");
    expect_close(left.fill + right.fill, whole.fill, "fill");
    expect_close(left.area + right.area, whole.area, "area");
}

TEST(Volume, SwapsWhenTheSurfacesAreExchanged) {
    for (int kind = 0; kind < test::kMeshKinds; ++kind) {
        const auto which = static_cast<test::MeshKind>(kind);
        if (which == test::MeshKind::Needles || which == test::MeshKind::FarAway) continue;
        for (std::uint64_t seed = 1; seed <= 12; ++seed) {
            test::Random random(seed * 100 + static_cast<std::uint64_t>(kind));
            const core::MeshData mesh = test::random_mesh(random, which, 7);
            core::MeshData moved = mesh;
            for (core::Point3& v : moved.vertices)
                v.z += test::uniform(random, -1, 1);
            const auto a = core::build_tin(mesh);
            const auto same = core::build_tin(moved);
            const auto other = core::build_tin(test::random_mesh(random, which, 5));
            if (!a || !same || !other) continue;
            SCOPED_TRACE(std::string(test::name_of(which)) + " " + std::to_string(seed));
            const Volume there = between(*a, *other), back = between(*other, *a);
            // Where the surfaces are one, what rounding leaves of the elevations remains.
            const double size = there.cut + there.fill + 1e-2 * there.area;
            EXPECT_NEAR(there.cut, back.fill, 1e-12 * size);
            EXPECT_NEAR(there.fill, back.cut, 1e-12 * size);
            EXPECT_NEAR(there.area, back.area, 1e-12 * there.area);
            EXPECT_EQ(there.pairs, back.pairs);
            const Volume own = between(*a, *same);
            EXPECT_EQ(own.pairs, a->triangle_count()) << "neighbours do not overlap";
            const Volume again = between(*a, *same);
            EXPECT_EQ(own.cut, again.cut);
            const Volume itself = between(*a, *a);
            EXPECT_EQ(itself.cut, 0.0);
            EXPECT_EQ(itself.fill, 0.0);
            if (testing::Test::HasFailure()) return;
        }
    }
}

TEST(Volume, AgreesWithFineSampling) {
    test::Random random(7);
    const auto a = core::build_tin(test::random_mesh(random, test::MeshKind::Jittered, 8));
    const auto b = core::build_tin(test::random_mesh(random, test::MeshKind::Delaunay, 6));
    ASSERT_TRUE(a && b);
    const core::Bounds& box = a->bounds();
    constexpr int kPerSide = 1500;
    const double dx = (box.max.x - box.min.x) / kPerSide, dy = (box.max.y - box.min.y) / kPerSide;
    double cut = 0, fill = 0, area = 0;
    for (int i = 0; i < kPerSide; ++i) {
        for (int j = 0; j < kPerSide; ++j) {
            const core::Point2 p{box.min.x + (i + 0.5) * dx, box.min.y + (j + 0.5) * dy};
            const auto ours = core::spot_at(*a, p), theirs = core::spot_at(*b, p);
            if (!ours || !theirs) continue;
            const double d = ours->elevation - theirs->elevation;
            (d > 0 ? cut : fill) += std::fabs(d) * dx * dy;
            area += dx * dy;
        }
    }
    const Volume found = between(*a, *b);
    EXPECT_GT(found.cut + found.fill, 0);
    EXPECT_NEAR(found.cut, cut, 2e-3 * (cut + fill));
    EXPECT_NEAR(found.fill, fill, 2e-3 * (cut + fill));
    EXPECT_NEAR(found.area, area, 2e-3 * area);
}

TEST(Volume, StopsWhenAsked) {
    const Tin tin = tilted(4, 1.0, 3.0, 0, 0);
    EXPECT_EQ(core::volume_between(tin, core::all_triangles(tin), tin, [] { return true; })
                  .errors()[0]
                  .code,
              core::ErrorCode::Cancelled);
    EXPECT_EQ(core::cut_out(tin, box(1, 1, 2, 2), core::Winding::EvenOdd,
                            {UINT64_MAX, UINT64_MAX, [] { return true; }})
                  .errors()[0]
                  .code,
              core::ErrorCode::Cancelled);
}

TEST(Plane, ByPointsAndBySlope) {
    const auto plane = core::plane_through({0, 0, 1}, {10, 0, 3}, {0, 10, 0});
    ASSERT_TRUE(plane);
    EXPECT_DOUBLE_EQ(plane->per_x, 0.2);
    EXPECT_DOUBLE_EQ(plane->per_y, -0.1);
    EXPECT_FALSE(core::plane_through({0, 0, 1}, {1, 1, 3}, {2, 2, 0}));
    const double quarters[4][2] = {{0, 0.5}, {0.5, 0}, {0, -0.5}, {-0.5, 0}};
    for (int i = -4; i < 8; ++i) {
        const core::Plane slope = core::sloping_plane(0.5, 90.0 * i, {});
        EXPECT_EQ(slope.per_x, quarters[(i + 4) % 4][0]) << i;
        EXPECT_EQ(slope.per_y, quarters[(i + 4) % 4][1]) << i;
    }
    for (const double azimuth : {10.0, 100.0, 190.0, 280.0, -10.0, 44.0, 46.0, 359.0}) {
        const core::Plane slope = core::sloping_plane(2.0, azimuth, {});
        const double angle = azimuth * std::acos(-1.0) / 180.0;
        EXPECT_NEAR(slope.per_x, 2.0 * std::sin(angle), 1e-14) << azimuth;
        EXPECT_NEAR(slope.per_y, 2.0 * std::cos(angle), 1e-14) << azimuth;
    }
}

}  // namespace
}  // namespace tinsmith
