// SPDX-License-Identifier: Apache-2.0
// Several shapes together, and meshes that are awkward themselves.
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::built;
using test::grid;
using test::integrate_checked;
using test::line;
using test::Outcome;
using test::ring;

std::uint64_t vertices_added(const Outcome& outcome) {
    std::uint64_t sum = 0;
    for (const ShapeReport& shape : outcome.report.shapes)
        sum += shape.vertices_added;
    return sum;
}

Outcome on_triangle(const std::vector<Shape>& shapes) {
    Tin tin = built(test::one_triangle());
    const Outcome outcome = integrate_checked(tin, shapes);
    EXPECT_EQ(outcome.broken, "");
    return outcome;
}

TEST(HardCase, TwoShapesThatCross) {
    EXPECT_EQ(vertices_added(on_triangle({ring({{10, 10}, {40, 10}, {40, 40}, {10, 40}}),
                                          ring({{5, 20}, {30, 5}, {50, 33}, {20, 60}})})),
              8u + 6u);
    EXPECT_EQ(vertices_added(on_triangle({line({{10, 20}, {50, 20}}), line({{20, 10}, {20, 40}})})),
              5u);
}

TEST(HardCase, TwoShapesThatShareAnEdge) {
    EXPECT_EQ(vertices_added(on_triangle({ring({{10, 10}, {30, 10}, {30, 30}, {10, 30}}),
                                          ring({{30, 10}, {50, 10}, {50, 30}, {30, 30}})})),
              6u);
    // In part: the neighbour's corners lie on the shared side.
    EXPECT_EQ(vertices_added(on_triangle({ring({{10, 10}, {30, 10}, {30, 30}, {10, 30}}),
                                          ring({{30, 15}, {50, 15}, {50, 25}, {30, 25}})})),
              8u);
    EXPECT_EQ(vertices_added(on_triangle({ring({{30, 15}, {50, 15}, {50, 25}, {30, 25}}),
                                          ring({{10, 10}, {30, 10}, {30, 30}, {10, 30}})})),
              8u);
}

TEST(HardCase, TwoShapesThatShareAVertex) {
    EXPECT_EQ(vertices_added(on_triangle(
                  {ring({{10, 10}, {30, 10}, {30, 30}}), ring({{30, 30}, {50, 30}, {40, 45}})})),
              5u);
    // The corner of one on the side of the other.
    EXPECT_EQ(vertices_added(on_triangle({ring({{10, 10}, {30, 10}, {30, 30}, {10, 30}}),
                                          ring({{30, 20}, {50, 25}, {50, 15}})})),
              7u);
}

TEST(HardCase, APolygonWithHoles) {
    Shape shape = ring({{0.3, 0.3}, {5.7, 0.4}, {5.6, 5.7}, {0.2, 5.5}});
    shape.paths.push_back({{{1.2, 1.3}, {1.4, 2.6}, {2.7, 2.2}}, true});
    shape.paths.push_back({{{3.2, 3.3}, {3.4, 4.6}, {4.7, 4.2}}, true});
    for (const auto diagonals : {test::Diagonals::Rising, test::Diagonals::Alternate}) {
        Tin tin = built(grid(6, 6, diagonals));
        const Outcome outcome = integrate_checked(tin, {shape});
        EXPECT_EQ(outcome.broken, "");
        EXPECT_EQ(outcome.shape().segments, 10u);
        EXPECT_EQ(outcome.shape().vertices_added, 10 + outcome.shape().crossings);
    }
}

TEST(HardCase, AMeshHoleCrossed) {
    // The hole is the cell from (1, 1) to (2, 2).
    Tin tin = built(test::ring_of_cells());
    const Outcome outcome = integrate_checked(tin, {line({{0.5, 1.25}, {2.5, 1.75}})});
    ASSERT_EQ(outcome.broken, "");
    ASSERT_EQ(outcome.shape().outside.size(), 1u);
    EXPECT_EQ(outcome.shape().outside[0].points.front().x, 1.0);
    EXPECT_EQ(outcome.shape().outside[0].points.back().x, 2.0);
}

TEST(HardCase, AMeshHoleMetInEveryWay) {
    for (const Shape& shape :
         {line({{0, 0}, {3, 3}}), line({{0, 1}, {3, 1}}), line({{0.5, 1}, {2.5, 1}}),
          line({{1.5, 1.5}, {2.5, 1.5}}), line({{1.5, 1.5}, {1.6, 1.4}, {0.5, 0.25}}),
          line({{1, 0.5}, {1, 2.5}}), line({{0.5, 1.5}, {1, 1.5}, {0.5, 0.5}}),
          ring({{1, 1}, {2, 1}, {2, 2}, {1, 2}}),
          ring({{0.5, 0.5}, {2.5, 0.5}, {2.5, 2.5}, {0.5, 2.5}}),
          ring({{1.2, 1.2}, {1.8, 0.6}, {1.8, 1.8}}), line({{2, 1}, {1, 2}}),
          line({{1.25, 1.75}, {2, 1}, {3, 0}}), line({{0, 2}, {2, 0}}), line({{1, 3}, {3, 1}})}) {
        for (const auto diagonals : {test::Diagonals::Rising, test::Diagonals::Falling}) {
            Tin tin = built(test::ring_of_cells(diagonals));
            EXPECT_EQ(integrate_checked(tin, {shape}).broken, "");
        }
    }
}

TEST(HardCase, SeveralComponents) {
    MeshData data = grid(2, 2);
    for (const double shift : {3.0, 6.0, 8.0}) {  // the last two touch along a line, unjoined
        const MeshData more = grid(2, 2, test::Diagonals::Falling);
        const auto base = static_cast<std::uint32_t>(data.vertices.size());
        for (const Point3& v : more.vertices)
            data.vertices.push_back({v.x + shift, v.y, std::sin(v.x + shift) + v.y * v.y});
        for (const auto& t : more.triangles)
            data.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    }
    Tin apart = built(data);
    const Outcome outcome = integrate_checked(apart, {line({{-1, 0.3}, {5.5, 1.7}})});
    EXPECT_EQ(outcome.broken, "");
    EXPECT_EQ(outcome.shape().outside.size(), 3u);
    Tin around = built(data);
    const Outcome enclosing =
        integrate_checked(around, {ring({{2.5, -1}, {5.5, -1}, {5.5, 3}, {2.5, 3}})});
    EXPECT_EQ(enclosing.broken, "");
    EXPECT_EQ(enclosing.shape().vertices_added, 0u);
}

TEST(HardCase, ComponentsThatTouchInAVertex) {
    const MeshData data{
        {{0, 0, 0}, {2, 1, 1}, {1, 2, 2}, {-2, -1, 3}, {-1, -2, 4}}, {{0, 1, 2}, {0, 3, 4}}, {}};
    for (const Shape& shape :
         {line({{1, 1}, {-1, -1}}), line({{-2, -2}, {2, 2}}), line({{0, 0}, {1, 1}}),
          line({{0, 0}, {-1, -1}}), line({{-1, -1}, {0, 0}, {1.2, 1}}), line({{-1, 1}, {1, -1}}),
          line({{2, 1}, {-2, -1}}), line({{-1, 1}, {0, 0}, {1, -1}}), line({{0, 0}})}) {
        Tin tin = built(data);
        EXPECT_EQ(integrate_checked(tin, {shape}).broken, "");
    }
}

TEST(HardCase, ARegularGridWhereEverythingIsDegenerate) {
    for (const double step : {1.0, 0.1, 30.0, 1.0 / 3.0}) {
        for (const auto diagonals :
             {test::Diagonals::Rising, test::Diagonals::Falling, test::Diagonals::Alternate}) {
            const auto at = [step](double x, double y) { return Point2{x * step, y * step}; };
            Tin tin = built(grid(8, 8, diagonals, step));
            const Outcome outcome = integrate_checked(
                tin, {ring({at(1, 1), at(7, 1), at(7, 7), at(1, 7)}),
                      ring({at(4, 1), at(7, 4), at(4, 7), at(1, 4)}),
                      ring({at(2.5, 2.5), at(5.5, 2.5), at(5.5, 5.5), at(2.5, 5.5)}),
                      line({at(0, 0), at(8, 8)}), line({at(0, 8), at(8, 0)}),
                      line({at(0, 2), at(8, 6)}), line({at(4, 0), at(4, 8)})});
            EXPECT_EQ(outcome.broken, "") << "step " << step;
        }
    }
}

TEST(HardCase, NeedlesOf1eMinus12Height) {
    // A strip whose triangles are 1 wide and 1e-12 high.
    MeshData data;
    for (unsigned i = 0; i <= 20; ++i) {
        data.vertices.push_back({i * 1.0, 0.0, i % 3 * 0.5});
        data.vertices.push_back({i + 0.5, 1e-12, i % 4 * 0.5});
    }
    for (std::uint32_t i = 0; i + 2 < data.vertices.size(); ++i)
        data.triangles.push_back(i % 2 == 0 ? std::array<std::uint32_t, 3>{i, i + 2, i + 1}
                                            : std::array<std::uint32_t, 3>{i, i + 1, i + 2});
    // On a mesh of this height rounding's reach, 1.4e-14, is a hundredth of a triangle.
    for (const Shape& shape :
         {line({{0.3, 2e-13}, {19.7, 7e-13}}), line({{5.2, -1}, {5.3, 1}}),
          line({{1.0, 0.0}, {15.5, 1e-12}}), line({{0.7, 4e-13}, {12.1, 4e-13}}),
          ring({{3.2, 1e-13}, {9.4, 3e-13}, {14.1, 8e-13}})}) {
        Tin tin = built(data);
        const Outcome outcome = integrate_checked(tin, {shape});
        EXPECT_TRUE(outcome.broken.empty() || outcome.broken.starts_with("NOT_REPRESENTABLE"))
            << outcome.broken;
        EXPECT_EQ(outcome.broken.find("the mesh changed"), std::string::npos);
    }
}

TEST(HardCase, DetailOfAMillimetreAt5e6Metres) {
    const Point2 corner{5e6, 4.5e6};
    for (const double step : {1.0, 0.125, 1e-3}) {
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> share(0.5, 5.5);
        for (int k = 0; k < 30; ++k) {
            Shape shape = ring({});
            for (int i = 0; i < 6; ++i) {
                const double x = corner.x + step * share(random);
                shape.paths[0].points.push_back({x, corner.y + step * share(random)});
            }
            Tin tin = built(grid(6, 6, test::Diagonals::Alternate, step, corner));
            const Outcome outcome = integrate_checked(tin, {shape});
            EXPECT_EQ(outcome.broken, "") << "step " << step << " case " << k;
        }
    }
    Shape small = ring({});  // a millimetre across in a triangle of 100 m
    for (int i = 0; i < 8; ++i)
        small.paths[0].points.push_back({corner.x + 30 + 5e-4 * std::cos(i * 0.785398163397448),
                                         corner.y + 30 + 5e-4 * std::sin(i * 0.785398163397448)});
    MeshData data = test::one_triangle();
    for (Point3& v : data.vertices)
        v = {v.x + corner.x, v.y + corner.y, v.z};
    Tin tin = built(data);
    const Outcome outcome = integrate_checked(tin, {small});
    EXPECT_EQ(outcome.broken, "");
    EXPECT_EQ(outcome.shape().vertices_added, 8u);
}

TEST(HardCase, ASegmentWithinRoundingOfAnEdge) {
    // From a start some ulps beside an edge of 90 m: no detour, nothing refused.
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> number(0.0, 1.0);
    for (const double offset : {0.0, 5e5}) {
        for (int k = 0; k < 300; ++k) {
            const double step = 90.0;
            const double x = offset + step * (1 + number(random));
            const double beside = (number(random) - 0.5) * 1e-11;
            const double y = offset + step * 2;
            const Point2 start{x, y + beside};
            const Point2 end{offset + step * (0.2 + 3.6 * number(random)),
                             offset + step * (0.2 + 3.6 * number(random))};
            Tin tin = built(grid(4, 4, test::Diagonals::Rising, step, {offset, offset}));
            EXPECT_EQ(integrate_checked(tin, {line({start, end})}).broken, "") << "case " << k;
            Tin back = built(grid(4, 4, test::Diagonals::Rising, step, {offset, offset}));
            EXPECT_EQ(integrate_checked(back, {line({end, start})}).broken, "") << "case " << k;
        }
    }
}

}  // namespace
}  // namespace tinsmith
